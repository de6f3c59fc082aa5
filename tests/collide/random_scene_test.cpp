// Proofs on random small scenes against the brute-force judge. AIRCUT_SCENES=n takes n scenes
// instead of the few of the fast run, AIRCUT_SEED=n other ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "base/text.h"
#include "collide/collide.h"
#include "collide/scenes.h"
#include "support/brute_force.h"

namespace aircut::collide {
namespace {

int from_environment(const char* name, int otherwise) {
  const char* wanted = std::getenv(name);
  const auto number = wanted != nullptr ? parse_number(wanted) : std::nullopt;
  return number && *number > 0 ? static_cast<int>(*number) : otherwise;
}

int scenes(int fast) { return from_environment("AIRCUT_SCENES", fast); }

struct Scene {
  TriangleMesh a, b;
  Screw screw;
  ProofOptions options;
};

/// Half of the scenes pass close by each other, so that hits, near misses and clear ones all occur.
Scene random_scene(Random& random) {
  Scene scene{random_body(random), random_body(random), {}, {}};
  const Pose turn = random.turned();
  const Vec3 side = random.direction();
  const Vec3 along = side.cross(random.direction()).normalized();
  const Vec3 offset = side * random.uniform(0, 5);
  const double length = random.uniform(0.5, 10);
  scene.screw.start = translation(offset - along * length * random.uniform(0.3, 1)) * turn;
  scene.screw.shift = along * length;
  if (random.pick(2) == 0) {
    scene.screw.axis = random.direction();
    scene.screw.centre = scene.screw.start.translation() + random.in_box(3);
    scene.screw.angle = random.uniform(-1.5, 1.5);
    scene.screw.radius = radius_about_axis(scene.b, scene.screw);
  }
  scene.options.margin = random.pick(3) == 0 ? 0.0 : random.uniform(0, 1.5);
  return scene;
}

struct Counts {
  int clear = 0, near = 0, hit = 0, unresolved = 0, unproven_hits = 0;
};

/// What the judge and the proof must agree on.
void compare(const Scene& scene, Counts& counts, const std::string& name) {
  SCOPED_TRACE(name);
  const CollisionMesh a(scene.a), b(scene.b);
  Budget budget;
  ProofCost cost;
  const Outcome outcome = prove(a, b, scene.screw.motion(), 0, 1, scene.options, budget, cost);
  const auto pose = [&](double t) { return scene.screw.at(t); };
  const double speed = scene.screw.travel(0, 1);
  const brute_force::Sampled truth = brute_force::sample_motion(
      brute_force::Solid(scene.a), brute_force::Solid(scene.b), pose, 0, 1, speed, 0.001);
  const double resolution = scene.options.resolution;

  if (const auto* clear = std::get_if<Clear>(&outcome)) {
    ++counts.clear;
    EXPECT_FALSE(truth.first_overlap);
    EXPECT_GE(truth.smallest, clear->distance);
    EXPECT_GE(clear->distance, scene.options.margin - resolution);
  } else if (const auto* near = std::get_if<Near>(&outcome)) {
    ++counts.near;
    EXPECT_FALSE(truth.first_overlap);
    EXPECT_GE(truth.smallest, near->distance_low);
    EXPECT_LE(near->distance_high, truth.smallest + resolution + 1e-6);
    EXPECT_LE(near->distance_high - near->distance_low, resolution + 1e-6);
    EXPECT_LT(near->distance_high, scene.options.margin);
    EXPECT_NEAR((near->on_a - near->on_b).norm(), near->distance_high, 1e-9);
  } else if (const auto* hit = std::get_if<Hit>(&outcome)) {
    ++counts.hit;
    EXPECT_TRUE(brute_force::overlap(scene.a, Pose::Identity(), scene.b, pose(hit->t_overlap)));
    EXPECT_LE(hit->t_first, hit->t_overlap);
    ASSERT_TRUE(truth.first_overlap);
    EXPECT_LE(hit->t_first, *truth.first_overlap);
    // Early by at most the resolution: no farther apart than that at t_first, touching soon after.
    EXPECT_LE(
        brute_force::overlap(scene.a, Pose::Identity(), scene.b, pose(hit->t_first))
            ? 0
            : brute_force::surface_distance(scene.a, Pose::Identity(), scene.b, pose(hit->t_first)),
        resolution + 1e-6);
  } else {
    ++counts.unresolved;
    const auto& range = std::get<Unresolved>(outcome);
    EXPECT_LE(range.distance_high, resolution);
    EXPECT_LE(range.t0, range.t1);
    if (truth.first_overlap) {
      EXPECT_LE(range.t0, *truth.first_overlap);
      // An overlap may stay unproven only if no corner shows it to be deep.
      for (int i = 0; i <= 200; ++i)
        EXPECT_LE(brute_force::corner_depth(scene.a, Pose::Identity(), scene.b, pose(i / 200.0)),
                  0.005);
      ++counts.unproven_hits;
    }
  }
}

TEST(RandomScenes, NeverHideAnOverlap) {
  Random random(static_cast<unsigned>(from_environment("AIRCUT_SEED", 20240501)));
  Counts counts;
  const int n = scenes(300);
  for (int i = 0; i < n && !testing::Test::HasFailure(); ++i)
    compare(random_scene(random), counts, fmt::format("scene {}", i));
  RecordProperty("clear", counts.clear);
  RecordProperty("near", counts.near);
  RecordProperty("hit", counts.hit);
  RecordProperty("unresolved", counts.unresolved);
  EXPECT_GT(counts.clear, n / 20);
  EXPECT_GT(counts.near, n / 20);
  EXPECT_GT(counts.hit, n / 5);
  EXPECT_LT(counts.unresolved, n / 20);
  fmt::print("clear {}, near {}, hit {}, unresolved {} ({} of them overlap)\n", counts.clear,
             counts.near, counts.hit, counts.unresolved, counts.unproven_hits);
}

/// Splits the motion into many proofs with a common budget.
std::vector<Outcome> in_steps(const Scene& scene, int steps, bool keep_budget, ProofCost& cost) {
  const CollisionMesh a(scene.a), b(scene.b);
  const RelativeMotion motion = scene.screw.motion();
  Budget budget;
  std::vector<Outcome> out;
  for (int i = 0; i < steps; ++i) {
    if (!keep_budget) budget = {};
    out.push_back(prove(a, b, motion, static_cast<double>(i) / steps,
                        static_cast<double>(i + 1) / steps, scene.options, budget, cost));
  }
  return out;
}

TEST(RandomScenes, GiveTheSameWithAndWithoutABudget) {
  Random random(77);
  std::uint64_t with = 0, without = 0;
  const int n = scenes(200);
  for (int i = 0; i < n; ++i) {
    const Scene scene = random_scene(random);
    ProofCost cost_with, cost_without;
    const auto kept = in_steps(scene, 60, true, cost_with);
    const auto fresh = in_steps(scene, 60, false, cost_without);
    with += cost_with.distance_queries;
    without += cost_without.distance_queries;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      // The start of a proof without a budget can fall a hair to the other side of a limit.
      const bool same = kept[k].index() == fresh[k].index();
      const auto* near = std::get_if<Near>(&fresh[k]);
      const bool borderline =
          near != nullptr && near->distance_high > scene.options.margin - scene.options.resolution;
      ASSERT_TRUE(same || borderline) << "scene " << i << " step " << k << ": " << kept[k].index()
                                      << " against " << fresh[k].index();
    }
  }
  EXPECT_LE(with, without);
}

std::string bits(const Outcome& outcome) {
  return std::visit(
      overloaded{[](const Clear& c) { return fmt::format("c{:a}", c.distance); },
                 [](const Near& n) {
                   return fmt::format("n{:a} {:a} {:a} {:a} {:a}", n.t, n.distance_low,
                                      n.distance_high, n.on_a.x(), n.on_b.z());
                 },
                 [](const Hit& h) {
                   return fmt::format("h{:a} {:a} {:a}", h.t_first, h.t_overlap, h.point.y());
                 },
                 [](const Unresolved& u) {
                   return fmt::format("u{:a} {:a} {:a} {:a}", u.t0, u.t1, u.distance_low,
                                      u.distance_high);
                 }},
      outcome);
}

TEST(RandomScenes, GiveTheSameBitsTwice) {
  const auto all = [] {
    Random random(31);
    std::string out;
    ProofCost cost;
    for (int i = 0; i < 100; ++i)
      for (const Outcome& outcome : in_steps(random_scene(random), 7, true, cost))
        out += bits(outcome) + "\n";
    return out + std::to_string(cost.distance_queries);
  };
  EXPECT_EQ(all(), all());
}

TEST(RandomScenes, KeepTheirHitsAtAFinerResolution) {
  Random random(404);
  const int n = scenes(200);
  for (int i = 0; i < n; ++i) {
    Scene scene = random_scene(random);
    const CollisionMesh a(scene.a), b(scene.b);
    bool was_hit = false;
    for (const double resolution : {0.1, 0.02, 0.005, 0.001}) {
      scene.options.resolution = resolution;
      Budget budget;
      ProofCost cost;
      const Outcome outcome = prove(a, b, scene.screw.motion(), 0, 1, scene.options, budget, cost);
      const bool is_hit = std::holds_alternative<Hit>(outcome);
      EXPECT_TRUE(is_hit || !was_hit || std::holds_alternative<Unresolved>(outcome))
          << "scene " << i << " at " << resolution;
      was_hit = was_hit || is_hit;
    }
  }
}

/// Boxes against a wall: the time of contact is known in closed form.
TEST(RandomScenes, MeetAWallAtTheExactTime) {
  Random random(99);
  for (int i = 0; i < scenes(200); ++i) {
    // A box moving at a plane wall, turned by any rotation.
    const Vec3 half = random.in_box(3).cwiseAbs() + Vec3::Constant(0.1);
    const TriangleMesh box = make_box(-half, half);
    const TriangleMesh wall = make_box({0, -40, -40}, {0.02, 40, 40});
    const Pose turn = random.turned();
    const double reach = (turn.linear().row(0).cwiseAbs() * half).value();
    const double start = -20, end = random.uniform(-10, 20);
    Screw screw = slide({start, random.uniform(-9, 9), 0}, {end, random.uniform(-9, 9), 0});
    screw.start = screw.start * turn;
    const CollisionMesh a(wall), b(box);
    Budget budget;
    ProofCost cost;
    const Outcome outcome = prove(a, b, screw.motion(), 0, 1, {.margin = 1}, budget, cost);
    const double gap = -reach - end;  // at the end, if it stays on this side
    if (gap > 1 + 1e-6) {
      EXPECT_TRUE(std::holds_alternative<Clear>(outcome)) << i;
    } else if (gap > 0.006) {
      ASSERT_TRUE(std::holds_alternative<Near>(outcome)) << i;
      EXPECT_LE(std::get<Near>(outcome).distance_low, gap + 1e-9);
      EXPECT_GE(std::get<Near>(outcome).distance_high, gap - 1e-9);
    } else if (gap < -0.01) {
      ASSERT_TRUE(std::holds_alternative<Hit>(outcome)) << i;
      const double contact = (-reach - start) / (end - start);
      const Hit& hit = std::get<Hit>(outcome);
      EXPECT_LE(hit.t_first, contact + 1e-9);
      EXPECT_GE(hit.t_first, contact - 0.005 / (end - start) - 1e-9);
    }
  }
}

}  // namespace
}  // namespace aircut::collide
