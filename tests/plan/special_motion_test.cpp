// Splines, probing, motion that is synchronised to the spindle.
#include <gtest/gtest.h>

#include "plan/geometry.h"
#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;
using Point = canon::SplineFeed::Point;

double x_of(const AxisValues& p) { return p[Axis::x]; }
double y_of(const AxisValues& p) { return p[Axis::y]; }

Planned plan_spline(const canon::SplineFeed& spline, const AxisValues& start) {
  const auto machine = mill();
  Program program;
  program.feed(30).add(spline);
  const Planned planned = plan_program(*machine, joints_at(*machine, start), program);
  EXPECT_TRUE(planned.errors.empty());
  return planned;
}

TEST(Spline, OfFourPointsIsTheBezierCurve) {
  const AxisValues start = xyz(1, 2, 5);
  const canon::SplineFeed spline{{{1, 2, 1}, {4, 9, 1}, {8, -3, 1}, {12, 4, 1}}, 4};
  const Planned planned = plan_spline(spline, start);
  // Every point of the path lies on the Bernstein form, looked for by brute force.
  double worst = 0, last_u = 0;
  for (const Segment& segment : planned.segments) {
    const double way = length(segment.path);
    if (way == 0) continue;
    for (int k = 0; k <= 50; ++k) {
      const AxisValues p = evaluate(segment.path, way * k / 50).p;
      EXPECT_EQ(p[Axis::z], 5);
      double nearest = 1e9;
      for (int i = 0; i <= 20000; ++i) {
        const double u = i / 20000.0, v = 1 - u;
        const double x = v * v * v * 1 + 3 * v * v * u * 4 + 3 * v * u * u * 8 + u * u * u * 12;
        const double y = v * v * v * 2 + 3 * v * v * u * 9 + 3 * v * u * u * -3 + u * u * u * 4;
        nearest = std::min(nearest, std::hypot(x - x_of(p), y - y_of(p)));
      }
      worst = std::max(worst, nearest);
    }
    EXPECT_NEAR(segment.u0, last_u, 1e-12);
    last_u = segment.u1;
  }
  EXPECT_EQ(last_u, 1);
  EXPECT_LT(worst, 1e-3);  // the judge's own step
}

TEST(Spline, WithWeightsOfAQuarterCircleIsRound) {
  const double w = std::sqrt(0.5);
  const canon::SplineFeed spline{{{10, 0, 1}, {10, 10, w}, {0, 10, 1}}, 3};
  const Planned planned = plan_spline(spline, xyz(10, 0, 0));
  double way = 0;
  for (const Segment& segment : planned.segments) {
    const double whole = length(segment.path);
    way += whole;
    for (int k = 0; whole > 0 && k <= 20; ++k) {
      const AxisValues p = evaluate(segment.path, whole * k / 20).p;
      EXPECT_NEAR(std::hypot(x_of(p), y_of(p)), 10, 1e-5);
    }
  }
  EXPECT_NEAR(way, 5 * std::numbers::pi, 1e-4);
}

TEST(Spline, OfManySpansIsRunWithoutAStop) {
  canon::SplineFeed spline;
  spline.order = 3;
  for (int i = 0; i < 12; ++i) spline.points.push_back({3.0 * i, i % 2 ? 2.0 : 0.0, 1});
  const Planned planned = plan_spline(spline, xyz(0, 0, 0));
  int stops = 0;
  double way = 0;
  for (const Segment& segment : planned.segments) {
    way += length(segment.path);
    if (!segment.profile.knots.empty()) stops += segment.profile.knots.back().v == 0;
  }
  EXPECT_EQ(stops, 1);
  EXPECT_GT(way, 33);
  const Segment& last = planned.segments.back();
  EXPECT_NEAR(x_of(evaluate(last.path, length(last.path)).p), 33, 1e-12);
}

TEST(Probe, GoesToItsEndAndRestsThere) {
  const auto machine = mill();
  Program program;
  program.feed(5).blend(0).line(xyz(10, 0, 0)).add(canon::Probe{xyz(10, 0, -20), false, false});
  program.line(xyz(20, 0, -20));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_TRUE(planned.errors.empty()) << planned.errors.front();
  bool seen = false;
  for (const Segment& segment : planned.segments) {
    if (segment.kind != MotionKind::probe) continue;
    seen = true;
    EXPECT_EQ(segment.profile.knots.front().v, 0);
    EXPECT_EQ(segment.profile.knots.back().v, 0);
    EXPECT_NEAR(length(segment.path), 20, 1e-12);
  }
  EXPECT_TRUE(seen);
}

Program turning(double rpm) {
  Program program;
  program.add(canon::SetSpindleSpeed{0, rpm});
  program.add(canon::TurnSpindle{0, canon::SpindleTurn::clockwise, true});
  return program;
}

class Thread : public testing::TestWithParam<double> {};  // jerk limit

TEST_P(Thread, WaitsForTheIndexCatchesUpAndKeepsToTheSpindle) {
  const auto machine = identity_machine("XYZ", {{100, 1000}, {100, 1000}, {50, 500, GetParam()}});
  Program program = turning(300);
  program.dwell(0.13).add(canon::SyncFeed{xyz(0, 0, -30), 2, false, 1, 0});
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_TRUE(planned.errors.empty()) << planned.errors.front();
  const double turn = 60.0 / 300, speed = 2 / turn;
  bool locked = false;
  double index = -1;
  for (const Segment& segment : planned.segments) {
    if (segment.kind == MotionKind::sync && index < 0) {
      EXPECT_NEAR(segment.t_end(), 0.2, 1e-9) << "the index comes once per turn";
      index = segment.t_end();
    }
    for (const ProfileKnot& knot : segment.profile.knots) {
      EXPECT_LE(std::abs(knot.a), 500 * (1 + 1e-9));
      EXPECT_LE(knot.v, 50 * (1 + 1e-9));
      EXPECT_LE(std::abs(knot.j), GetParam() * (1 + 1e-9));
    }
    if (!segment.sync) continue;
    locked = true;
    EXPECT_EQ(segment.sync_problem, "");
    // From the middle of the way on, the axis is where the angle wants it.
    for (int k = 0; k <= 20; ++k) {
      const double t = segment.duration() * (0.5 + 0.5 * k / 20);
      EXPECT_NEAR(segment.profile.at(t).s, speed * t, 1e-6);
      EXPECT_NEAR(2 * std::abs(spindle_turns(segment, t)), speed * t, 1e-6);
    }
  }
  EXPECT_TRUE(locked);
  EXPECT_NEAR(planned.segments.back().profile.knots.back().v, 0, 0);
}

INSTANTIATE_TEST_SUITE_P(Sync, Thread,
                         testing::Values(std::numeric_limits<double>::infinity(), 10000));

TEST(RigidTap, GoesDownAndBackWithTheSpindle) {
  const auto machine = mill();
  Program program = turning(600);
  program.add(canon::SyncFeed{xyz(0, 0, -12), 1.25, true, 1, 0});
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_TRUE(planned.errors.empty()) << planned.errors.front();
  double lowest = 0, turns = 0, last_u = 0;
  AxisValues tip;
  for (const Segment& segment : planned.segments) {
    if (segment.kind != MotionKind::sync) continue;
    EXPECT_NEAR(segment.u0, last_u, 1e-12);
    last_u = segment.u1;
    tip = evaluate(segment.path, length(segment.path)).p;
    lowest = std::min(lowest, tip[Axis::z]);
    turns += spindle_turns(segment, segment.duration());
  }
  EXPECT_EQ(last_u, 1);
  EXPECT_NEAR(lowest, -12, 1e-12);
  EXPECT_NEAR(tip[Axis::z], 0, 1e-12);
  EXPECT_NEAR(turns, 0, 1e-9) << "as many turns back as down";
}

TEST(RigidTap, ThatTheAxisCanNotFollowSaysSo) {
  const auto machine = mill();
  for (const double rpm : {3000.0, 900.0}) {  // too fast; too short to catch up
    Program program = turning(rpm);
    program.add(canon::SyncFeed{xyz(0, 0, rpm > 1000 ? -20 : -0.5), 1.25, true, 1, 0});
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    ASSERT_TRUE(planned.errors.empty()) << planned.errors.front();
    int problems = 0;
    for (const Segment& segment : planned.segments) problems += !segment.sync_problem.empty();
    EXPECT_EQ(problems, 1) << rpm;
    EXPECT_NEAR(evaluate(planned.segments.back().path, 1e9).p[Axis::z], 0, 1e-9);
  }
}

TEST(Rapid, StraightInJointSpaceIsStraightWhereJointsAreAxes) {
  const auto machine = mill();
  Program program;
  program.rapid(xyz(30, 10, -5));
  const double t = plan_program(*machine, zeros(*machine), program).time();
  machine->rapid_ = machine::RapidMode::joint;
  EXPECT_EQ(plan_program(*machine, zeros(*machine), program).time(), t);
}

TEST(Spindle, IsWaitedForWhereItHasAnAcceleration) {
  const auto machine = mill();
  Program program = turning(1200);
  program.add(canon::SetSpindleSpeed{0, 600}).dwell(1);
  program.add(canon::TurnSpindle{0, canon::SpindleTurn::counterclockwise, true});
  EXPECT_NEAR(plan_program(*machine, zeros(*machine), program).time(), 1, 1e-12);
  machine->spindle_.acceleration = 10;  // rev/s²
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  // 20 rev/s up, 10 down, 20 from 10 forward to 10 backward.
  EXPECT_NEAR(planned.time(), 2 + 1 + 1 + 2, 1e-12);
  double turns = 0;
  for (const Segment& segment : planned.segments)
    turns += spindle_turns(segment, segment.duration());
  EXPECT_NEAR(turns, 20.0 * 2 / 2 + 15.0 * 1 + 10.0 * 1 + 0, 1e-9);
  const Segment& up = planned.segments[1];
  EXPECT_NEAR(spindle_rpm(up, 0.5), 300, 1e-9);
  EXPECT_NEAR(spindle_turns(up, 1), 5, 1e-9);
}

TEST(RigidTap, TurnsRoundNoFasterThanTheSpindleCan) {
  const auto machine = mill();
  Program program = turning(600);
  program.add(canon::SyncFeed{xyz(0, 0, -12), 1.25, true, 1, 0});
  const auto steepest = [&] {
    double out = 0;
    for (const Segment& segment : plan_program(*machine, zeros(*machine), program).segments)
      if (segment.sync && segment.sync->spindle_follows)
        for (const ProfileKnot& knot : segment.profile.knots) out = std::max(out, std::abs(knot.a));
    return out;
  };
  EXPECT_NEAR(steepest(), 500, 1e-9);  // Z's own limit
  machine->spindle_.acceleration = 80;
  EXPECT_NEAR(steepest(), 80 * 1.25, 1e-9);
}

}  // namespace
}  // namespace aircut::plan
