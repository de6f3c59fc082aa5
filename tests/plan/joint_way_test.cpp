// Rapids that are straight in the joints: closed forms, and joints by differences.
#include <gtest/gtest.h>

#include "plan/plan.h"
#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

// Rest to rest over L under V and A (planner rule of single moves).
double time_of(double length, double v, double a) {
  return length >= v * v / a ? length / v + v / a : 2 * std::sqrt(length / a);
}

TEST(JointWay, EachJointOfADoglegGoesAsFastAsItCan) {
  const auto machine = mill();  // X Y 100 mm/s, 1000 mm/s²; Z half of both
  machine->rapid_ = machine::RapidMode::dogleg;
  Program program;
  program.rapid(xyz(80, 3, -30));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_EQ(planned.segments.size(), 1u);
  const Segment& rapid = planned.segments.front();
  EXPECT_EQ(rapid.kind, MotionKind::rapid);
  EXPECT_NEAR(rapid.duration(), time_of(80, 100, 1000), 1e-12);
  const auto& way = std::get<JointWay>(rapid.path);
  const auto at = [&](double t) { return joint_point(way, rapid.profile.at(t).s); };
  // Y is there after its own time and waits.
  const double y = time_of(3, 100, 1000), z = time_of(30, 50, 500);
  EXPECT_LT(at(y - 0.005).q[1], 3 - 1e-6);
  EXPECT_NEAR(at(y).q[1], 3, 1e-9);
  EXPECT_NEAR(at(rapid.duration()).q[1], 3, 0);
  EXPECT_NEAR(at(z).q[2], -30, 1e-9);
  EXPECT_NEAR(at(z / 2).q[2], -15, 1e-9);
  EXPECT_EQ(evaluate(rapid.path, way.length).p.value, xyz(80, 3, -30).value);
}

TEST(JointWay, AllJointsOfAJointRapidAreInStep) {
  const auto machine = identity_machine("XYZ", {{100, 1000}, {100, 1000}, {50, 500}});
  machine->rapid_ = machine::RapidMode::dogleg;
  const AxisValues end = xyz(80, 3, -30);
  machine->rapid_ = machine::RapidMode::joint;
  const auto found = joint_rapid(*machine, machine->kinematics(), zeros(*machine), {}, end, {});
  ASSERT_TRUE(found);
  // X is the slowest of the three alone, and all take its time.
  EXPECT_NEAR(found->profile.duration(), time_of(80, 100, 1000), 1e-12);
  for (const double f : {0.1, 0.4, 0.9}) {
    const machine::JointVector q = joint_point(found->way, f * found->way.length).q;
    EXPECT_NEAR(q[0], 80 * f, 1e-12);
    EXPECT_NEAR(q[2], -30 * f, 1e-12);
  }
}

TEST(JointWay, KeepsTheJerkLimit) {
  const auto machine = identity_machine("XYZ", {{100, 1000, 20000}, {80, 800, 9000}, {50, 500}});
  machine->rapid_ = machine::RapidMode::dogleg;
  Program program;
  program.rapid(xyz(80, 13, -30)).rapid(xyz(0, 0, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_EQ(planned.segments.size(), 2u);
  const Segment& rapid = planned.segments.front();
  const auto& way = std::get<JointWay>(rapid.path);
  constexpr double dt = 1e-3;
  const auto q = [&](double t) { return joint_point(way, rapid.profile.at(t).s).q; };
  const double limits[] = {20000, 9000};
  for (double t = 0; t < rapid.duration() - 3 * dt; t += dt) {
    const machine::JointVector third = q(t + 3 * dt) - 3 * q(t + 2 * dt) + 3 * q(t + dt) - q(t);
    for (int j = 0; j < 2; ++j)
      EXPECT_LE(std::abs(third[j]) / (dt * dt * dt), limits[j] * 1.001) << t;
  }
}

TEST(JointWay, IsRefusedWhereJointsFollowOthers) {
  const auto machine = ox_machine();
  machine->rapid_ = machine::RapidMode::joint;
  Program program;
  program.rapid(xyz(240, 5, -310));
  const Planned planned = plan_program(*machine, joints_at(*machine, xyz(250, 0, -300)), program);
  ASSERT_EQ(planned.errors.size(), 1u);
  EXPECT_TRUE(planned.errors[0].starts_with("unsupported_code")) << planned.errors[0];
}

}  // namespace
}  // namespace aircut::plan
