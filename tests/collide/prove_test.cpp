#include <gtest/gtest.h>

#include "collide/collide.h"
#include "collide/scenes.h"

namespace aircut::collide {
namespace {

TriangleMesh cube(double size) {
  return make_box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2));
}

Outcome prove_all(const TriangleMesh& a, const TriangleMesh& b, const Screw& screw,
                  const ProofOptions& options = {}, ProofCost* cost_out = nullptr) {
  const CollisionMesh ca(a), cb(b);
  Budget budget;
  ProofCost cost;
  const Outcome out = prove(ca, cb, screw.motion(), 0, 1, options, budget, cost);
  if (cost_out != nullptr) *cost_out = cost;
  return out;
}

const char* name_of(const Outcome& outcome) {
  constexpr const char* names[] = {"Clear", "Near", "Hit", "Unresolved"};
  return names[outcome.index()];
}

template <class T>
T as(const Outcome& outcome) {
  EXPECT_TRUE(std::holds_alternative<T>(outcome)) << "is " << name_of(outcome);
  return std::holds_alternative<T>(outcome) ? std::get<T>(outcome) : T{};
}

TEST(Proof, FindsACubeThatPassesThroughACube) {
  const Screw pass = slide({-100, 0.3, 0.2}, {100, 0.3, 0.2});
  const Hit hit = as<Hit>(prove_all(cube(2), cube(2), pass));
  const double contact = 98.0 / 200;  // the gap of 98 of 200 mm
  EXPECT_LE(hit.t_first, contact);
  EXPECT_GE(hit.t_first, contact - 0.005 / 200 - 1e-9);
  EXPECT_GT(hit.t_overlap, contact);
  EXPECT_LT(hit.t_overlap, contact + 0.02 / 200);
  EXPECT_NEAR(hit.point.x(), -1, 0.05);
}

TEST(Proof, FindsACubeThatPassesThroughAnEqualCubeInLine) {
  // All sides lie in the same planes: no two triangles cut each other.
  const Hit hit = as<Hit>(prove_all(cube(2), cube(2), slide({-100, 0, 0}, {100, 0, 0})));
  EXPECT_NEAR(hit.t_first, 0.49, 0.005 / 200 + 1e-9);
  EXPECT_LE(hit.t_first, 0.49);
}

TEST(Proof, FindsAnEqualBlockPushedInALittle) {
  const Hit hit = as<Hit>(prove_all(cube(2), cube(2), slide({-3, 0, 0}, {-1.95, 0, 0})));
  EXPECT_LE(hit.t_first, 1 / 1.05);
}

TEST(Proof, FindsAThinSheetCrossedAtFullRapid) {
  const TriangleMesh sheet = make_box({-0.01, -50, -50}, {0.01, 50, 50});
  const Screw pass = slide({-300, 1, 2}, {300, 1, 2});
  ProofCost cost;
  const Hit hit = as<Hit>(prove_all(sheet, cube(4), pass, {}, &cost));
  EXPECT_NEAR(hit.t_first, (300 - 2.01) / 600, 0.005 / 600 + 1e-9);
  EXPECT_LT(cost.distance_queries, 30u);
}

TEST(Proof, FindsTwoThinSheetsThatCross) {
  const TriangleMesh sheet = make_box({-0.01, -5, -5}, {0.01, 5, 5});
  const Hit hit = as<Hit>(prove_all(sheet, sheet, slide({-500, 1, 2}, {500, 1, 2})));
  EXPECT_NEAR(hit.t_first, (500 - 0.02) / 1000, 0.005 / 1000 + 1e-9);
}

TEST(Proof, FindsANeedleThroughASurfaceWithoutThickness) {
  const TriangleMesh sheet{{{0, -50, -50}, {0, 50, -50}, {0, 0, 80}}, {{0, 1, 2}}};
  as<Hit>(prove_all(sheet, make_box({-1, -0.02, -0.02}, {1, 0.02, 0.02}),
                    slide({-300, 1, 2}, {300, 1, 2})));
}

TEST(Proof, SeesABodyThatStartsInsideAnother) {
  const Hit hit = as<Hit>(prove_all(cube(10), cube(1), slide({0, 0, 0}, {1, 0, 0})));
  EXPECT_EQ(hit.t_first, 0);
  EXPECT_EQ(hit.t_overlap, 0);
}

TEST(Proof, SeesCoincidentBodies) {
  const Hit hit = as<Hit>(prove_all(cube(3), cube(3), slide({0, 0, 0}, {0, 0, 0})));
  EXPECT_EQ(hit.t_overlap, 0);
}

TEST(Proof, FindsABarThatTurnsIntoAPost) {
  const TriangleMesh bar = make_box({0, -0.5, -1}, {20, 0.5, 1});
  const TriangleMesh post = make_box({-1, 15, -5}, {1, 17, 5});
  Screw turn{.axis = Vec3::UnitZ(), .angle = 3.0};
  turn.radius = radius_about_axis(bar, turn);
  const Hit hit = as<Hit>(prove_all(post, bar, turn));
  // The upper face of the bar meets the post's corner (1, 15), at distance r from the axis and
  // height 0.5 over the bar's middle.
  const double r = std::hypot(1, 15);
  const double contact = (std::atan2(15, 1) - std::asin(0.5 / r)) / 3.0;
  EXPECT_LE(hit.t_first, contact);
  EXPECT_GT(hit.t_first, contact - 0.01 / (3.0 * r));
}

TEST(Proof, KeepsANearMissApartFromAContact) {
  const Near near =
      as<Near>(prove_all(cube(2), cube(2), slide({-100, 2.3, 0}, {100, 2.3, 0}), {.margin = 2}));
  EXPECT_LE(near.distance_low, 0.3);
  EXPECT_GE(near.distance_high, 0.3 - 1e-12);
  EXPECT_LE(near.distance_high - near.distance_low, 0.005 + 1e-9);
  EXPECT_NEAR(near.on_a.y(), 1, 1e-9);
  EXPECT_NEAR(near.on_b.y(), 1.3, 1e-9);
}

TEST(Proof, MeasuresTheNearestPlaceOfARotation) {
  const TriangleMesh bar = make_box({-10, -1, -1}, {10, 1, 1});
  const TriangleMesh wall = make_box({10.5, -30, -30}, {12, 30, 30});
  Screw turn{.axis = Vec3::UnitZ(), .angle = 2.0};
  turn.radius = radius_about_axis(bar, turn);
  const double reach = std::hypot(10, 1);
  const Near near = as<Near>(prove_all(wall, bar, turn, {.margin = 1}));
  EXPECT_LE(near.distance_low, 10.5 - reach + 1e-9);
  EXPECT_GE(near.distance_high, 10.5 - reach - 1e-9);
  EXPECT_LE(near.distance_high - near.distance_low, 0.005 + 1e-9);
  EXPECT_NEAR(near.t, std::atan2(1, 10) / 2, 0.02);
}

TEST(Proof, IsClearBeyondTheMargin) {
  const Clear clear =
      as<Clear>(prove_all(cube(2), cube(2), slide({-100, 4.5, 0}, {100, 4.5, 0}), {.margin = 2}));
  EXPECT_EQ(clear.distance, 2);
}

TEST(Proof, AtTheMarginItselfIsClearOrNearWithinTheResolution) {
  const Outcome out = prove_all(cube(2), cube(2), slide({-20, 4, 0}, {20, 4, 0}), {.margin = 2});
  if (const auto* clear = std::get_if<Clear>(&out))
    EXPECT_GE(clear->distance, 2 - 0.005);
  else
    EXPECT_GE(as<Near>(out).distance_low, 2 - 0.005);
}

TEST(Proof, LeavesARestingContactUnresolvedAndEnds) {
  ProofCost cost;
  const Unresolved rest = as<Unresolved>(prove_all(make_box({-200, -200, -10}, {200, 200, 0}),
                                                   make_box({-5, -5, 0}, {5, 5, 10}),
                                                   slide({-100, 0, 0}, {100, 0, 0}), {}, &cost));
  EXPECT_EQ(rest.t0, 0);
  EXPECT_EQ(rest.t1, 1);
  EXPECT_EQ(rest.distance_low, 0);
  EXPECT_LE(rest.distance_high, 1e-9);
  EXPECT_LT(cost.distance_queries, 3000u);
}

TEST(Proof, DoesNotTakeAShallowRubForAHit) {
  const TriangleMesh table = make_box({-20, -20, -10}, {20, 20, 0});
  const TriangleMesh block = make_box({-5, -5, 0}, {5, 5, 10});
  as<Unresolved>(prove_all(table, block, slide({-1, 0, -0.0005}, {1, 0, -0.0005})));
  as<Hit>(prove_all(table, block, slide({-1, 0, -0.0015}, {1, 0, -0.0015})));
}

TEST(Proof, FindsAPlungeAfterAContact) {
  const TriangleMesh table = make_box({-20, -20, -10}, {20, 20, 0});
  const TriangleMesh block = make_box({-5, -5, 0}, {5, 5, 10});
  const CollisionMesh ca(table), cb(block);
  // Slides for 0.9 s in contact, then sinks by 0.1 mm.
  const RelativeMotion motion{
      .X_AB = [](double t) -> std::optional<Pose> {
        return translation({10 * std::min(t, 0.9), 0, -std::max(0.0, t - 0.9)});
      },
      .travel = [](double ta, double tb) -> std::optional<double> { return 10 * (tb - ta); }};
  Budget budget;
  ProofCost cost;
  const Hit hit = as<Hit>(prove(ca, cb, motion, 0, 1, {}, budget, cost));
  EXPECT_EQ(hit.t_first, 0);
  EXPECT_GT(hit.t_overlap, 0.901 - 1e-9);
  EXPECT_LT(hit.t_overlap, 0.93);
}

TEST(Proof, IsUnresolvedWhereThePoseOrTheTravelIsUnknown) {
  const CollisionMesh mesh(cube(2));
  const auto pose = [](double t) -> std::optional<Pose> { return translation({5 + t, 0, 0}); };
  const auto travel = [](double ta, double tb) -> std::optional<double> { return tb - ta; };
  const RelativeMotion no_pose{
      .X_AB = [&](double t) { return t > 0.4 && t < 0.6 ? std::nullopt : pose(t); },
      .travel = travel};
  const RelativeMotion no_travel{.X_AB = pose,
                                 .travel = [&](double ta, double tb) -> std::optional<double> {
                                   return tb > 0.4 && ta < 0.6 ? std::nullopt : travel(ta, tb);
                                 }};
  Budget budget;
  ProofCost cost;
  const Unresolved second = as<Unresolved>(prove(mesh, mesh, no_travel, 0, 1, {}, budget, cost));
  EXPECT_LE(second.t0, 0.4);
  EXPECT_GE(second.t0, 0.3);
  EXPECT_GE(second.t1, 0.6);
  EXPECT_LE(second.t1, 0.7);
  EXPECT_GT(budget.distance, 0);
  // Without a pose, travel alone still carries a proof; it must not where the distance is used up.
  budget = {};
  const RelativeMotion never{.X_AB = [](double) { return std::optional<Pose>(); },
                             .travel = travel};
  as<Unresolved>(prove(mesh, mesh, never, 0, 1, {}, budget, cost));
  EXPECT_LT(budget.distance, 0);
  const RelativeMotion endless{
      .X_AB = pose, .travel = [](double, double) -> std::optional<double> { return HUGE_VAL; }};
  budget = {};
  as<Unresolved>(prove(mesh, mesh, endless, 0, 1, {}, budget, cost));
  const RelativeMotion nonsense{
      .X_AB = pose, .travel = [](double, double) -> std::optional<double> { return std::nan(""); }};
  budget = {};
  as<Unresolved>(prove(mesh, mesh, nonsense, 0, 1, {}, budget, cost));
  EXPECT_NE(no_pose.X_AB(0.1), std::nullopt);
}

TEST(Proof, OfAnEmptyIntervalLooksAtItsPose) {
  const CollisionMesh mesh(cube(2));
  Budget budget;
  ProofCost cost;
  const Screw apart = slide({5, 0, 0}, {6, 0, 0}), into = slide({1, 0, 0}, {2, 0, 0});
  as<Clear>(prove(mesh, mesh, apart.motion(), 0, 0, {.margin = 1}, budget, cost));
  budget = {};
  as<Hit>(prove(mesh, mesh, into.motion(), 0, 0, {.margin = 1}, budget, cost));
}

TEST(Budget, SparesQueriesWhileTheBodiesAreFarApart) {
  const CollisionMesh mesh(cube(2));
  const Screw path = slide({-1000, 30, 0}, {1000, 30, 0});
  Budget budget;
  ProofCost cost;
  for (int i = 0; i < 20000; ++i)
    as<Clear>(prove(mesh, mesh, path.motion(), i / 20000.0, (i + 1) / 20000.0, {.margin = 2},
                    budget, cost));
  EXPECT_LT(cost.distance_queries, 100u);
}

TEST(Budget, IsGoneAfterAContact) {
  const CollisionMesh mesh(cube(2));
  Budget budget;
  ProofCost cost;
  prove(mesh, mesh, slide({-10, 0, 0}, {0, 0, 0}).motion(), 0, 1, {}, budget, cost);
  EXPECT_LT(budget.distance, 0);
}

}  // namespace
}  // namespace aircut::collide
