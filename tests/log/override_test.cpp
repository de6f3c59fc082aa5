// Overrides and holds: what they do to time, and that joints, feed and path stay as they must.
#include <gtest/gtest.h>

#include "support/log_checker.h"
#include "support/run_log.h"

namespace aircut::test {
namespace {

using plan::OverrideEvent;
using What = plan::OverrideEvent::What;

Planned plan_with(const machine::Machine& machine, const Program& program,
                  std::vector<OverrideEvent> events) {
  plan::Options options;
  options.overrides = std::move(events);
  return plan_program(machine, zeros(machine), program, options);
}

// A line long enough that ramps count for little, and back.
Program there_and_back(double way = 200) {
  Program out;
  return out.exact_stop().feed(20).line(xyz(way, 0, 0)).line(xyz(0, 0, 0));
}

JointLog logged(const std::shared_ptr<const machine::Machine>& machine, const Planned& planned) {
  return read_log(run_to_log(machine, zeros(*machine), planned));
}

void expect_limits(const JointLog& log) {
  EXPECT_TRUE(log.problems.empty());
  for (const Worst& worst : {worst_velocity(log), worst_acceleration(log), worst_jerk(log)})
    EXPECT_LE(worst.share, 1.001) << worst.where;
  EXPECT_LE(worst_feed(log).share, 1.001) << worst_feed(log).where;
}

std::shared_ptr<machine::Machine> jerk_mill() {
  return identity_machine("XYZ", {{100, 1000, 20000}, {100, 1000, 20000}, {50, 500, 10000}});
}

class Override : public testing::TestWithParam<bool> {
 protected:
  std::shared_ptr<machine::Machine> machine_ = GetParam() ? jerk_mill() : mill();
};

TEST_P(Override, OfHalfTheFeedTakesTwiceTheTimeAndOfTwiceTheFeedHalfOfIt) {
  const double plain = plan_with(*machine_, there_and_back(50), {}).time();
  for (const double factor : {0.5, 2.0, 0.1}) {
    const Planned planned = plan_with(*machine_, there_and_back(50), {{0, What::feed, factor}});
    ASSERT_TRUE(planned.errors.empty());
    EXPECT_NEAR(planned.time(), plain / factor, 0.05 * plain / factor) << factor;
  }
}

TEST_P(Override, ActsFromItsTimeOn) {
  // 10 s each way; from 5 s on half as fast: 5 + 10 + 20.
  const Planned planned = plan_with(*machine_, there_and_back(), {{5, What::feed, 0.5}});
  EXPECT_NEAR(planned.time(), 35, 0.3);
  const JointLog log = logged(machine_, planned);
  expect_limits(log);
  EXPECT_NEAR(log.value(4800, "feed_act"), 20, 1e-3);
  EXPECT_NEAR(log.value(5200, "feed_act"), 10, 1e-3);
  EXPECT_NEAR(log.value(5200, "feed_cmd"), 10, 1e-3);
}

// Up to the event the rows are those of the program without it; at it braking begins.
TEST_P(Override, ChangesNothingBeforeItsTimeAndBrakesFromThenOn) {
  Program program;
  program.exact_path().feed(30);
  for (int i = 1; i <= 8; ++i)
    program.line(xyz(9 * i, 0, i % 2 ? 0 : 4)).arc(xyz(9 * i, 0, i % 2 ? 0 : 4), 9 * i - 2, 0, 1);
  program.line(xyz(0, 0, 0));
  const JointLog plain = logged(machine_, plan_with(*machine_, program, {}));
  for (const double t : {0.02, 0.31, 2.3, 5.02, 7.777}) {
    const Planned planned = plan_with(*machine_, program, {{t, What::hold}, {t + 1, What::resume}});
    const JointLog log = logged(machine_, planned);
    expect_limits(log);
    const auto row = static_cast<std::size_t>(1000 * t);
    for (std::size_t k = 0; k + 3 < row; ++k)
      for (const char* q : {"q0", "q1", "q2"})
        ASSERT_NEAR(log.value(k, q), plain.value(k, q), 0.01) << t << " row " << k;
    // It rests when hard braking is over, at most 30 mm/s with 500 mm/s² and ramps of 25 ms.
    EXPECT_EQ(log.value(row + 140, "feed_act"), 0) << t;
    EXPECT_GT(log.value(row + 1030, "feed_act"), 0) << t;
  }
}

// What is left of the line is 5e-8 mm, and a row falls there.
TEST(OverrideEvent, RightBeforeALinesEndLeavesTheFeedInMillimetres) {
  const auto machine = mill();
  Program program;
  program.exact_stop().feed(20).line(xyz(10.0001, 0, 0));
  const double end = plan_with(*machine, program, {}).time();
  const Planned planned = plan_with(*machine, program, {{end - 1e-5, What::feed, 0.5}});
  const JointLog log = logged(machine, planned);
  ASSERT_GT(log.rows.size(), 520u);
  EXPECT_LE(log.value(520, "feed_cmd"), 20);
  EXPECT_GE(log.value(520, "feed_cmd"), 10);
}

TEST_P(Override, NeverMakesAJointFasterThanItIs) {
  const Planned planned = plan_with(*machine_, there_and_back(), {{3, What::feed, 20}});
  const JointLog log = logged(machine_, planned);
  expect_limits(log);
  double fastest = 0;
  for (std::size_t row = 0; row < log.rows.size(); ++row)
    fastest = std::max(fastest, log.value(row, "feed_act"));
  EXPECT_NEAR(fastest, 100, 0.5);
}

TEST_P(Override, OfRapidsActsOnRapidsAlone) {
  Program program;
  program.exact_stop().feed(20).rapid(xyz(200, 0, 0)).line(xyz(100, 0, 0));
  const double plain = plan_with(*machine_, program, {}).time();
  const double slow = plan_with(*machine_, program, {{0, What::rapid, 0.25}}).time();
  EXPECT_NEAR(slow - plain, 200 / 25.0 - 200 / 100.0, 0.2);
  expect_limits(logged(machine_, plan_with(*machine_, program, {{1, What::rapid, 0.25}})));
}

// X goes 80 mm at 100 mm/s, Z 20 mm at 50: it is there first.
TEST_P(Override, OfADoglegSlowsEachJointDownFromItsTimeOn) {
  machine_->rapid_ = machine::RapidMode::dogleg;
  Program program;
  program.rapid(xyz(80, 0, 20)).rapid(xyz(0, 0, 0));
  const double ramp = GetParam() ? 0.05 : 0;
  EXPECT_NEAR(plan_with(*machine_, program, {}).time(), 2 * (0.9 + ramp), 1e-9);
  EXPECT_NEAR(plan_with(*machine_, program, {{0, What::rapid, 0.25}}).time(),
              2 * (80 / 25.0 + 0.025 + (GetParam() ? 0.025 / std::sqrt(0.5) : 0)), 0.03);
  // From 0.5 s on: X has gone 45 mm (42.5 with the jerk's ramp).
  const Planned planned = plan_with(*machine_, program, {{0.5, What::rapid, 0.5}});
  const JointLog log = logged(machine_, planned);
  expect_limits(log);
  EXPECT_NEAR(log.value(500, "v0"), 100, 1e-6);
  EXPECT_LT(log.value(502, "v0"), 100);
  EXPECT_NEAR(log.value(620, "v0"), 50, 1e-6);
  EXPECT_NEAR(log.rows.back()[log.column("x")], 0, 1e-9);
}

TEST_P(Override, HoldsADoglegAndGoesOnAtItsTimes) {
  machine_->rapid_ = machine::RapidMode::dogleg;
  Program program;
  program.rapid(xyz(80, 3, 20)).rapid(xyz(0, 0, 0)).feed(20).line(xyz(1, 0, 0));
  const double plain = plan_with(*machine_, program, {}).time();
  for (double t = 0; t < 1.9; t += 0.163) {
    const Planned planned = plan_with(*machine_, program,
                                      {{t, What::hold},
                                       {t + 0.4, What::resume},
                                       {t + 0.45, What::rapid, 0.3},
                                       {t + 0.5, What::rapid, 1}});
    ASSERT_TRUE(planned.errors.empty());
    const JointLog log = logged(machine_, planned);
    expect_limits(log);
    EXPECT_GE(planned.time(), plain + (t < 1.5 ? 0.2 : 0)) << t;
    EXPECT_LT(planned.time(), plain + 0.8) << t;
    const auto row = static_cast<std::size_t>(1000 * t) + 399;
    double moves = 0;
    for (const char* v : {"v0", "v1", "v2"}) moves = std::max(moves, std::abs(log.value(row, v)));
    if (t < 0.6) {
      EXPECT_EQ(moves, 0) << t;
    }
    EXPECT_NEAR(log.rows.back()[log.column("x")], 1, 1e-9);
  }
}

TEST_P(Override, HoldStopsGoesOnAtItsTimeAndChangesNothingOfThePath) {
  const Planned planned =
      plan_with(*machine_, there_and_back(), {{4, What::hold}, {7, What::resume}});
  const JointLog log = logged(machine_, planned);
  expect_limits(log);
  const double plain = plan_with(*machine_, there_and_back(), {}).time();
  EXPECT_NEAR(planned.time(), plain + 3, 0.2);
  for (std::size_t row = 4150; row < 7000; ++row)
    ASSERT_EQ(log.value(row, "x"), log.value(4150, "x")) << row;
  EXPECT_NEAR(log.value(4150, "x"), 80, 2);
  EXPECT_GT(log.value(7100, "x"), log.value(4150, "x"));
  double highest = 0;
  for (std::size_t row = 0; row < log.rows.size(); ++row)
    highest = std::max(highest, log.value(row, "x"));
  EXPECT_NEAR(highest, 200, 1e-6);
  EXPECT_NEAR(log.rows.back()[log.column("x")], 0, 1e-9);
}

TEST_P(Override, BrakesOverTheEndsOfShortLinesAndAroundCornersWithinTheTolerance) {
  Program program;
  program.blend(0.05).merge(0).feed(40);
  for (int i = 1; i <= 120; ++i)
    program.line(xyz(0.4 * i, 5 * std::sin(0.1 * i), 0.02 * i * (i % 2)));
  const Planned plain = plan_with(*machine_, program, {});
  for (double t = 0.05; t < plain.time(); t += 0.41) {
    const Planned planned = plan_with(*machine_, program,
                                      {{t, What::feed, 0.2},
                                       {t + 0.01, What::feed, 1.5},
                                       {t + 0.2, What::hold},
                                       {t + 0.4, What::resume},
                                       {t + 0.45, What::feed, 0.7}});
    ASSERT_TRUE(planned.errors.empty());
    const JointLog log = logged(machine_, planned);
    expect_limits(log);
    EXPECT_LE(worst_path_deviation(log, ideal_path(program, {}, 0.05)).share, 1e-6) << t;
    EXPECT_EQ(planned.segments.back().command.block, program.commands().back().block);
  }
}

TEST_P(Override, IsLeftOutWhereTheProgramSaysSo) {
  using Kind = canon::Override::Kind;
  Program program;
  program.exact_stop().feed(20).add(canon::Override{Kind::feed, false}).line(xyz(100, 0, 0));
  program.add(canon::Override{Kind::feed, true}).line(xyz(0, 0, 0));
  const Planned planned = plan_with(*machine_, program, {{0, What::feed, 0.5}});
  EXPECT_NEAR(planned.time(), 5 + 10, 0.2);

  Program held;
  held.exact_stop().feed(20).add(canon::Override{Kind::feed_hold, false}).line(xyz(100, 0, 0));
  held.add(canon::Override{Kind::feed_hold, true}).line(xyz(0, 0, 0));
  const Planned waits = plan_with(*machine_, held, {{1, What::hold}, {9, What::resume}});
  const JointLog log = logged(machine_, waits);
  expect_limits(log);
  EXPECT_EQ(log.value(6000, "x"), 100);  // not before the line's end, then until 9 s
  EXPECT_EQ(log.value(8990, "x"), 100);
  EXPECT_NEAR(waits.time(), 14, 0.2);

  Program adaptive;
  adaptive.exact_stop().feed(20).line(xyz(100, 0, 0));
  adaptive.add(canon::Override{Kind::adaptive_feed, true}).line(xyz(0, 0, 0));
  EXPECT_NEAR(plan_with(*machine_, adaptive, {{0, What::adaptive, 0.5}}).time(), 5 + 10, 0.2);
}

TEST_P(Override, OfTheSpindleTurnsItSlowerAndFeedsPerRevolutionSlower) {
  Program program;
  program.exact_stop().add(canon::SetSpindleSpeed{0, 1200});
  program.add(canon::TurnSpindle{0, canon::SpindleTurn::clockwise, true});
  program.add(canon::SetFeedMode{canon::FeedMode::per_revolution});
  program.add(canon::SetFeedRate{1, 0}).line(xyz(100, 0, 0));
  const Planned planned = plan_with(*machine_, program, {{1, What::spindle, 0.5}});
  EXPECT_NEAR(planned.time(), 1 + 8, 0.2);
  const JointLog log = logged(machine_, planned);
  expect_limits(log);
  EXPECT_EQ(log.value(500, "spindle_rpm"), 1200);
  EXPECT_EQ(log.value(1500, "spindle_rpm"), 600);
}

TEST_P(Override, ThatHoldsForEverOrComesOutOfOrderIsRefused) {
  for (const std::vector<OverrideEvent>& events : {std::vector<OverrideEvent>{{1, What::hold}},
                                                   {{1, What::feed, 0}},
                                                   {{2, What::feed, 0.5}, {1, What::feed, 1}},
                                                   {{1, What::feed, -1}}}) {
    const Planned planned = plan_with(*machine_, there_and_back(), events);
    ASSERT_FALSE(planned.errors.empty());
    EXPECT_TRUE(planned.errors.front().starts_with("overrides_invalid")) << planned.errors.front();
  }
}

INSTANTIATE_TEST_SUITE_P(Planner, Override, testing::Bool(), [](const auto& param) {
  return param.param ? "WithJerkLimits" : "WithoutJerkLimits";
});

}  // namespace
}  // namespace aircut::test
