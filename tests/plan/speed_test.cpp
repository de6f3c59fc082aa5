// The speed planner on its own: moves between speeds, and kinematics that are far from linear.
#include "plan/speed.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

nlohmann::json vectors(const std::string& name) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/planner/" + name);
  return nlohmann::json::parse(in)["cases"];
}

// A uniform piece: one axis.
Grid straight(double length, double v, double a) {
  Grid grid;
  grid.uniform = true;
  grid.uniform_a = a;
  grid.joints = 1;
  grid.at = {{0, v * v, 1, {LimitedBy::velocity, 0}}, {length, v * v, 1, {LimitedBy::velocity, 0}}};
  return grid;
}

// The same with nodes, as an arc or another machine would have it.
Grid with_nodes(double length, double v, double a, int n) {
  Grid grid;
  grid.joints = 1;
  for (int k = 0; k <= n; ++k) {
    grid.at.push_back({length * k / n, v * v, 1, {LimitedBy::velocity, 0}});
    grid.rows.insert(grid.rows.end(), {1 / a, 0});
  }
  return grid;
}

TEST(Ride, BetweenTwoSpeedsTakesTheTimeOfTheVectors) {
  int compared = 0;
  for (const auto& c : vectors("planner-speed-to-speed.json")) {
    if (c["t_acc_limited"].is_null()) continue;
    const double v0 = c["v_start"], v1 = c["v_end"], t = c["t_acc_limited"];
    const double length = c["distance_mm"], v = c["v_max"], a = c["a_max"];
    Controllable controllable;
    const Grid exact = straight(length, v, a);
    brake(exact, v1 * v1, controllable);
    ASSERT_GE(controllable.front(), v0 * v0 * (1 - 1e-12));
    EXPECT_NEAR(accelerate(exact, controllable, v0 * v0).profile.duration(), t, 1e-9 * t);
    const Grid coarse = with_nodes(length, v, a, 2000);
    brake(coarse, v1 * v1, controllable);
    EXPECT_NEAR(accelerate(coarse, controllable, v0 * v0).profile.duration(), t, 1e-3 * t);
    ++compared;
  }
  EXPECT_GE(compared, 4);
}

TEST(Ride, ThatCanNotBrakeInTimeHasNoSuchStart) {
  Controllable controllable;
  brake(straight(1, 100, 1000), 25, controllable);
  EXPECT_NEAR(controllable.front(), 25 + 2000, 1e-9);
}

// Joints r = |p|, θ = angle of p in the XY plane; no rates, no bounds: differences do it.
class Polar final : public machine::Kinematics {
 public:
  std::string_view type() const override { return "polar"; }
  AxisSet axes() const override {
    AxisSet out;
    out.add(Axis::x);
    out.add(Axis::y);
    return out;
  }
  int joint_count() const override { return 2; }
  tl::expected<machine::JointVector, machine::ReachError> inverse(
      const machine::Target& target, const machine::JointVector& near) const override {
    const double x = target.tip[Axis::x], y = target.tip[Axis::y];
    if (x == 0 && y == 0) return unexpected(machine::ReachError{"the centre has no angle"});
    machine::JointVector q(2);
    const double angle = std::atan2(y, x), turn = 2 * std::numbers::pi;
    q << std::hypot(x, y), angle + turn * std::round((near[1] - angle) / turn);
    return q;
  }
  tl::expected<AxisValues, machine::ReachError> forward(const machine::JointVector& q,
                                                        const AxisValues&) const override {
    return xyz(q[0] * std::cos(q[1]), q[0] * std::sin(q[1]), 0);
  }
  bool travel_bound(const machine::TipInterval&, std::span<double>) const override { return false; }
};

std::shared_ptr<machine::Machine> polar_machine(double v_r, double v_theta, double a) {
  auto m = std::make_shared<machine::Machine>();
  add_joint(*m, "r", false, {v_r, a});
  add_joint(*m, "theta", true, {v_theta / rad, a / rad});
  m->kinematics_ = std::make_shared<Polar>();
  return m;
}

TEST(Descent, OfAHeldMotionThatHardlyMovesRestsAtOnce) {
  const Grid grid = with_nodes(1, 50, 1000, 2);
  const Controllable held(grid.nodes(), 0.0);
  for (const double b : {1e-17, 1e-9, 1.0}) {
    const Descent descent = descend(grid, held, b);
    EXPECT_TRUE(descent.done);
    EXPECT_NEAR(descent.ride.b_end, 0, 1e-9 * b);
    EXPECT_NEAR(descent.ride.profile.duration(), std::sqrt(b) / 1000, 1e-3 * std::sqrt(b) / 1000);
  }
}

TEST(Descent, ThatEndsAtRestAHairBeforeANodeHasAnEnd) {
  const Grid grid = with_nodes(1, 50, 1000, 2);
  const Controllable held(grid.nodes(), 0.0);
  for (const double hair : {1e-12, 1e-13, 1e-14}) {
    const Descent descent = descend(grid, held, 1000 * (1 - hair));
    EXPECT_TRUE(descent.done);
    EXPECT_EQ(descent.ride.b_end, 0) << hair;
    EXPECT_NEAR(descent.s, 0.5, 1e-9);
    EXPECT_NEAR(descent.ride.profile.duration(), std::sqrt(1000.0) / 1000, 1e-9);
  }
}

TEST(Descent, EndsWithTheVerySpeedThatIsAskedFor) {
  const Grid grid = with_nodes(1, 50, 1000, 7);
  for (const double wanted : {0.0, 3.7, 25.1})
    for (double b = wanted + 1; b < wanted + 1900; b *= 1.07) {
      const Descent descent = descend(grid, Controllable(grid.nodes(), wanted), b);
      EXPECT_TRUE(descent.done);
      EXPECT_EQ(descent.ride.b_end, wanted) << b;
    }
}

TEST(Ride, OverTheRestOfAPieceThatWasHeldInItsLastIntervalEnds) {
  const Grid rest = grid_behind(with_nodes(1, 50, 1000, 4), 0.9);
  Controllable controllable;
  brake(rest, 0, controllable);
  const Ride ride = accelerate(rest, controllable, 0);
  EXPECT_NEAR(ride.profile.duration(), 2 * std::sqrt(0.1 / 1000), 1e-9);
}

TEST(Polar, CentreIsPassedAsSlowlyAsTheAngleNeeds) {
  for (const auto& c : vectors("planner-polar-singularity.json")) {
    const double offset = c["offset_mm"], half = c["half_length_mm"];
    // Accelerations without effect: the ramps at both ends take 1e-7 s.
    const auto machine = polar_machine(c["v_r_mm_s"], c["v_theta_rad_s"], 1e9);
    Program program;
    program.feed(c["feed"]).line(xyz(half, offset, 0));
    const AxisValues start = xyz(-half, offset, 0);
    const Planned planned = plan_program(*machine, joints_at(*machine, start), program);
    ASSERT_TRUE(planned.errors.empty());
    ASSERT_FALSE(planned.segments.back().failure) << planned.segments.back().failure->message;
    const double t = c["t_velocity_limited"];
    EXPECT_NEAR(planned.time(), t, 2e-3 * t) << c.dump();
    double slowest = 1e300;
    const auto& knots = planned.segments.back().profile.knots;
    for (std::size_t i = 3; i + 3 < knots.size(); ++i)
      if (std::abs(knots[i].s - half) < half / 2) slowest = std::min(slowest, knots[i].v);
    EXPECT_NEAR(slowest, c["v_min_at_centre"].get<double>(), 0.02 * slowest) << c.dump();
  }
}

TEST(Polar, LineThroughTheCentreEndsThere) {
  const auto machine = polar_machine(100, 2, 1000);
  Program program;
  program.feed(50).line(xyz(30, 0, 0)).line(xyz(30, 10, 0));
  const Planned planned = plan_program(*machine, joints_at(*machine, xyz(-50, 0, 0)), program);
  ASSERT_FALSE(planned.segments.empty());
  ASSERT_TRUE(planned.segments.back().failure);
  EXPECT_EQ(planned.segments.back().command.block, 2u);
  EXPECT_NEAR(planned.segments.back().failure->fraction, 50.0 / 80, 0.02);
}

}  // namespace
}  // namespace aircut::plan
