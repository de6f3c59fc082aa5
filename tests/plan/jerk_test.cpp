// Third order: times against closed forms and the numeric optimum.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

nlohmann::json cases_of(const std::string& name) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/planner/" + name);
  return nlohmann::json::parse(in)["cases"];
}

TEST(JerkLimit, SingleMovesTakeTheClosedFormsTime) {
  for (const auto& c : cases_of("planner-single.json")) {
    if (c["j_max"].is_null()) continue;
    const double distance = c["distance_mm"], t = c["t_jerk_limited"];
    const auto machine = identity_machine("X", {{c["v_max"], c["a_max"], c["j_max"]}});
    Program program;
    program.rapid(xyz(distance, 0, 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    EXPECT_NEAR(planned.time(), t, 1e-9 * t) << c.dump();
    const auto& knots = planned.segments.back().profile.knots;
    double peak = 0, a = 0;
    for (const ProfileKnot& knot : knots) peak = std::max(peak, knot.v), a = std::max(a, knot.a);
    EXPECT_NEAR(peak, c["v_peak_jerk_limited"].get<double>(), 1e-9 * peak);
    EXPECT_NEAR(a, c["a_peak_jerk_limited"].get<double>(), 1e-9 * a);
    EXPECT_EQ(knots.back().s, distance);
  }
}

TEST(JerkLimit, CirclesAreWithinAHundredthOfTheNumericOptimum) {
  for (const auto& c : cases_of("planner-circle-joint-box.json")) {
    const double r = c["radius_mm"];
    std::vector<JointLimit> limits;
    for (int j = 0; j < 2; ++j) limits.push_back({c["v_max"][j], c["a_max"][j], c["j_max"][j]});
    const auto machine = identity_machine("XY", limits);
    Program program;
    program.feed(c["feed"]).arc(xyz(r, 0, 0), 0, 0);
    const Planned planned = plan_program(*machine, joints_at(*machine, xyz(r, 0, 0)), program);
    const double t = c["t_jerk_limited"];
    EXPECT_GT(planned.time(), t * (1 - 1e-2)) << c.dump();
    EXPECT_LT(planned.time(), t * (1 + 1e-2)) << c.dump();
  }
}

TEST(JerkLimit, CornersTakeTheFasterOfBlendAndStop) {
  for (const auto& c : cases_of("planner-corner.json")) {
    std::vector<JointLimit> limits;
    for (int j = 0; j < 2; ++j) limits.push_back({c["v_max"][j], c["a_max"][j], c["j_max"][j]});
    const auto machine = identity_machine("XY", limits);
    const double a = c["lengths_mm"][0], b = c["lengths_mm"][1];
    const double turn = c["turn_deg"].get<double>() * rad;
    Program program;
    program.feed(c["feed"]).blend(c["tolerance_mm"]);
    program.line(xyz(a, 0, 0)).line(xyz(a + b * std::cos(turn), b * std::sin(turn), 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    const double t =
        std::min(c["t_blend_jerk"].get<double>(), c["t_exact_stop_jerk"].get<double>());
    EXPECT_LT(planned.time(), t * (1 + 1e-2)) << c.dump();
  }
}

std::shared_ptr<machine::Machine> jerky(double k = 1) {
  return identity_machine("XYZ", {{100 * k, 1000 * k * k, 20000 * k * k * k},
                                  {100 * k, 1000 * k * k, 20000 * k * k * k},
                                  {50 * k, 500 * k * k, 10000 * k * k * k}});
}

Program wave(int lines, double step, double k = 1, bool back = false) {
  Program program;
  program.feed(40 * k).blend(0.02);
  const auto at = [&](int i) {
    const double a = i * step / 10;
    return xyz(20 * std::sin(a), 10 * std::sin(1.7 * a), 3 * std::sin(3 * a));
  };
  for (int i = 1; i <= lines; ++i) program.line(back ? at(lines - i) : at(i));
  return program;
}

double wave_time(const machine::Machine& machine, const Program& program, Options options = {}) {
  const Planned planned = plan_program(machine, zeros(machine), program, options);
  EXPECT_TRUE(planned.errors.empty());
  return planned.time();
}

TEST(JerkLimit, SplittingALineChangesNothing) {
  const auto machine = jerky();
  Program whole, split;
  whole.feed(50).line(xyz(100, 50, 20));
  split.feed(50).exact_path();
  for (int i = 1; i <= 1000; ++i) split.line(xyz(0.1 * i, 0.05 * i, 0.02 * i));
  const double t = wave_time(*machine, whole);
  EXPECT_NEAR(wave_time(*machine, split), t, 1e-6 * t);
}

TEST(JerkLimit, ReversingAPathTakesTheSameTime) {
  const auto machine = jerky();
  const double forth = wave_time(*machine, wave(60, 1));
  Program back = wave(60, 1, 1, true);
  AxisValues start;
  const double a = 60.0 / 10;
  start = xyz(20 * std::sin(a), 10 * std::sin(1.7 * a), 3 * std::sin(3 * a));
  const Planned planned = plan_program(*machine, joints_at(*machine, start), back);
  // The log's samples lie elsewhere on the way back, so other places are repaired.
  EXPECT_NEAR(planned.time(), forth, 5e-4 * forth);
}

// Feed and speed k times as large, acceleration k² and jerk k³ times, the period divided by k.
TEST(JerkLimit, ScalingSpeedsDividesTheTime) {
  const double t = wave_time(*jerky(), wave(20, 1));
  for (const double k : {0.5, 2.0, 3.0}) {
    Options options;
    options.period = 0.001 / k;
    EXPECT_NEAR(wave_time(*jerky(k), wave(20, 1, k), options), t / k, 1e-6 * t / k) << k;
  }
}

TEST(JerkLimit, PermutingAxesOrMovingTheStartChangesNothing) {
  const std::vector<JointLimit> limits(3, {100, 1000, 20000});
  const auto machine = identity_machine("XYZ", limits);
  const auto time_of = [&](int first, const AxisValues& start) {
    Program program;
    program.feed(40).blend(0.05);
    for (int i = 1; i <= 12; ++i) {
      AxisValues to = start;
      to.value[static_cast<std::size_t>(first)] += 3 * i;
      to.value[static_cast<std::size_t>((first + 1) % 3)] += i % 2 ? 4 : 0;
      program.line(to);
    }
    return plan_program(*machine, joints_at(*machine, start), program).time();
  };
  const double t = time_of(0, {});
  EXPECT_NEAR(time_of(1, {}), t, 1e-6 * t);
  EXPECT_NEAR(time_of(2, {}), t, 1e-6 * t);
  EXPECT_NEAR(time_of(0, xyz(30, -70, 11)), t, 1e-6 * t);
}

// ---- traps of other planners -----------------------------------------------------------------

// Short chords of a curve must not be ridden from zero acceleration to zero acceleration.
TEST(Trap, ADensePathDoesNotCrawlUnderAJerkLimit) {
  const auto machine = jerky();
  constexpr double r = 500, angle = 0.3;
  constexpr int chords = 300;
  const auto at = [](double a) { return xyz(r * std::cos(a), r * std::sin(a), 0); };
  Program arc, dense;
  arc.feed(60).arc(at(angle), 0, 0);
  dense.feed(60).blend(0.01).merge(0);
  for (int i = 1; i <= chords; ++i) dense.line(at(angle * i / chords));
  const auto start = joints_at(*machine, at(0));
  const double t = plan_program(*machine, start, arc).time();
  EXPECT_NEAR(plan_program(*machine, start, dense).time(), t, 0.01 * t);
}

// With a limit of the tip alone a path takes the same time in every direction; with a box of joint
// limits what is allowed along a direction changes by √2 at most, and a time from rest to rest by
// its square root at most.
TEST(Trap, TheDirectionOfAPathCountsNoMoreThanTheLimitsSay) {
  const auto turned = [](double degrees, bool jerk) {
    const auto machine = jerk ? identity_machine("XY", {{200, 1000, 20000}, {200, 1000, 20000}})
                              : identity_machine("XY", {{200, 1e6}, {200, 1e6}});
    if (!jerk) machine->tip_acceleration_ = 1000;
    const auto at = [&](double x, double y) {
      const double c = std::cos(degrees * rad), s = std::sin(degrees * rad);
      return xyz(c * x - s * y, s * x + c * y, 0);
    };
    Program program;
    program.feed(50).blend(0.05);
    for (int i = 0; i < 5; ++i) program.line(at(4 * i + 4, 4 * i)).line(at(4 * i + 4, 4 * i + 4));
    return plan_program(*machine, zeros(*machine), program).time();
  };
  for (const double degrees : {10.0, 22.5, 30.0, 45.0}) {
    EXPECT_NEAR(turned(degrees, false), turned(0, false), 0.005 * turned(0, false)) << degrees;
    EXPECT_NEAR(turned(degrees, true), turned(0, true), 0.19 * turned(0, true)) << degrees;
  }
}

TEST(JerkLimit, MoreOfAnyLimitIsHardlySlower) {
  const auto base = jerky();
  const double t = wave_time(*base, wave(60, 1));
  for (const double factor : {1.05, 1.3, 2.0})
    for (int j = 0; j < 3; ++j) {
      const auto faster = jerky();
      faster->tree_[static_cast<std::size_t>(j)].jmax *= factor;
      EXPECT_LE(wave_time(*faster, wave(60, 1)), t * 1.001) << j << ' ' << factor;
    }
  EXPECT_GT(t, wave_time(*mill(), wave(60, 1))) << "a jerk limit costs time";
}

TEST(JerkLimit, BeyondAllMeasureGivesTheSecondOrdersTime) {
  const auto machine = jerky();
  for (const int j : machine->driven_) machine->tree_[static_cast<std::size_t>(j)].jmax = 1e9;
  const double t = wave_time(*mill(), wave(40, 1));
  EXPECT_NEAR(wave_time(*machine, wave(40, 1)), t, 0.01 * t);
}

TEST(JerkLimit, GivesTheSameLawForEveryWindowThatCoversTheBraking) {
  const auto machine = jerky();
  const Program program = wave(800, 0.5);
  Options small;
  small.max_nodes = 20000;
  const Planned a = plan_program(*machine, zeros(*machine), program);
  const Planned b = plan_program(*machine, zeros(*machine), program, small);
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i)
    ASSERT_EQ(a.segments[i].t_end(), b.segments[i].t_end()) << i;
}

TEST(JerkLimit, TimeLawsAreContinuousToTheAcceleration) {
  const auto machine = jerky();
  const Planned planned = plan_program(*machine, zeros(*machine), wave(200, 0.5));
  SpeedProfile::State last;
  for (const Segment& segment : planned.segments) {
    if (segment.profile.knots.empty()) continue;
    const SpeedProfile::State first = segment.profile.at(0);
    // Blends run at unit speed only to about 1e-4.
    EXPECT_NEAR(first.v, last.v, 3e-4 * last.v + 1e-9);
    EXPECT_NEAR(first.a, last.a, 3e-4 * std::abs(last.a) + 2e-2);
    const ProfileKnot& end = segment.profile.knots.back();
    last = {end.s, end.v, end.a};
    EXPECT_NEAR(end.s, length(segment.path), 1e-12);
    for (std::size_t i = 0; i + 1 < segment.profile.knots.size(); ++i) {
      const ProfileKnot &k = segment.profile.knots[i], &next = segment.profile.knots[i + 1];
      const double d = next.t - k.t;
      EXPECT_NEAR(k.s + d * (k.v + d * (k.a / 2 + d * k.j / 6)), next.s, 1e-6);
      EXPECT_NEAR(k.v + d * (k.a + d * k.j / 2), next.v, 1e-4);
    }
  }
  EXPECT_EQ(last.v, 0);
}

}  // namespace
}  // namespace aircut::plan
