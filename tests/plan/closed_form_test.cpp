// Times against closed forms: single moves, feed rules, exact-stop programs.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

/// By value: a range-for over a part of a temporary would dangle.
nlohmann::json cases_of(const std::string& name) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/planner/" + name);
  return nlohmann::json::parse(in)["cases"];
}

TEST(SingleMove, TakesTheClosedFormsTime) {
  for (const auto& c : cases_of("planner-single.json")) {
    const double v = c["v_max"], a = c["a_max"], distance = c["distance_mm"];
    const auto machine = identity_machine("X", {{v, a}});
    Program program;
    program.rapid(xyz(distance, 0, 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    const double t = c["t_acc_limited"];
    EXPECT_NEAR(planned.time(), t, 1e-9 * t) << c.dump();
    const auto& knots = planned.segments.back().profile.knots;
    double peak = 0;
    for (const ProfileKnot& knot : knots) peak = std::max(peak, knot.v);
    EXPECT_NEAR(peak, c["v_peak_acc_limited"].get<double>(), 1e-9 * peak);
    EXPECT_DOUBLE_EQ(knots.back().s, distance);
    EXPECT_EQ(knots.back().v, 0);
  }
}

TEST(FeedRules, GiveTheTimesOfTheVectors) {
  for (const auto& c : cases_of("planner-feed-rules.json")) {
    const std::string letters = "XYZABC";
    std::vector<JointLimit> limits;
    for (const char l : letters) {
      const auto& limit = c["limits"][std::string(1, l)];
      limits.push_back({limit[0], limit[1]});
    }
    const auto machine = identity_machine(letters, limits);
    AxisValues end;
    for (const auto& [name, value] : c["delta"].items()) {
      const Axis axis = *axis_of_letter(name[0]);
      end[axis] = value.get<double>() * (is_rotary(axis) ? rad : 1);
    }
    Program program;
    const std::string mode = c["mode"];
    if (mode == "rapid") {
      program.rapid(end);
    } else {
      const double f = c["F"];
      if (mode == "G93") {
        program.add(canon::SetFeedMode{canon::FeedMode::inverse_time});
        program.add(canon::SetFeedRate{f / 60, 0});
      } else if (mode == "G95") {
        program.add(canon::SetFeedMode{canon::FeedMode::per_revolution});
        program.add(canon::SetSpindleSpeed{0, c["rpm"]});
        program.add(canon::TurnSpindle{0, canon::SpindleTurn::clockwise, true});
        program.add(canon::SetFeedRate{f, 0});
      } else {
        program.feed(f / 60);
      }
      program.line(end);
    }
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    ASSERT_TRUE(planned.errors.empty()) << planned.errors.front();
    const double t = c["t_acc_limited"];
    EXPECT_NEAR(planned.time(), t, 1e-9 * t) << c.dump();
  }
}

TEST(SpeedToSpeed, TangentLinesWithDifferentFeedsShareOneRamp) {
  // 20 mm at 60 mm/s, then on at 100: as one move with the cap of each half.
  const auto machine = mill();
  Program program;
  program.exact_path().feed(60).line(xyz(20, 0, 0)).feed(100).line(xyz(60, 0, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  // Ramp 0 → 60, cruise, ramp 60 → 100, cruise, ramp 100 → 0.
  const double t = 0.06 + (20 - 1.8) / 60 + 0.04 + (40 - 3.2 - 5) / 100 + 0.1;
  EXPECT_NEAR(planned.time(), t, 1e-9 * t);
}

TEST(ExactStop, AddsUpTheSingleMoves) {
  const auto machine = mill();
  Program program;
  program.exact_stop().feed(50).line(xyz(50, 0, 0)).line(xyz(50, 40, 0)).dwell(0.25);
  program.line(xyz(60, 40, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  EXPECT_NEAR(planned.time(), 1.05 + 0.85 + 0.25 + 0.25, 1e-9);
}

TEST(Commands, AllReachTheListenersInOrderWithTheirTime) {
  const auto machine = mill();
  Program program;
  program.add(canon::UseUnit{}).feed(50).line(xyz(10, 0, 0));
  program.add(canon::Message{canon::Message::Kind::message, "on the way"});
  program.line(xyz(20, 0, 0)).line(xyz(20, 0, 0));
  program.add(canon::ChangeTool{4}).add(canon::ToolLengthOffset{xyz(0, 0, 30)});
  program.add(canon::Coolant{canon::Coolant::Kind::flood, true}).dwell(2);
  program.rapid(xyz(20, 0, -30)).add(canon::ProgramEnd{});
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  std::uint64_t block = 0;
  double t = 0;
  for (const Segment& segment : planned.segments) {
    EXPECT_GE(segment.command.block, block);
    EXPECT_LE(segment.command.block, block + 1) << "a command is missing";
    block = segment.command.block;
    EXPECT_EQ(segment.t_start, t);
    t = segment.t_end();
    if (std::holds_alternative<canon::Dwell>(segment.command.action)) {
      EXPECT_EQ(segment.duration(), 2);
    }
    if (std::holds_alternative<canon::ChangeTool>(segment.command.action)) {
      EXPECT_EQ(segment.duration(), 3);
      EXPECT_EQ(segment.kind, MotionKind::tool_change);
    }
    // The tool got longer: the joints stand still and the tip is lower; the rapid goes nowhere.
    if (std::holds_alternative<canon::Rapid>(segment.command.action)) {
      EXPECT_EQ(segment.duration(), 0);
    }
  }
  EXPECT_EQ(block, program.commands().size());
  // The two halves of the straight line are passed without a stop in between.
  EXPECT_NEAR(t, 0.45 + 3 + 2, 1e-9);
}

TEST(Commands, WithoutAModelAreErrorsAndNeverSkipped) {
  const auto machine = mill();
  Program program;
  program.add(canon::SetSpindleMode{0, 2000}).add(canon::SetSpindleSpeed{0, 100});
  program.add(canon::TurnSpindle{0, canon::SpindleTurn::clockwise, true});
  program.add(canon::SyncFeed{xyz(0, 0, -5), 1, false, 1, 0});
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_EQ(planned.errors.size(), 1u);
  EXPECT_TRUE(planned.errors[0].starts_with("unsupported_code")) << planned.errors[0];
}

TEST(Feed, MustBeThere) {
  const auto machine = mill();
  Program program;
  program.line(xyz(1, 0, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  ASSERT_EQ(planned.errors.size(), 1u);
  EXPECT_TRUE(planned.errors[0].starts_with("feed_missing")) << planned.errors[0];
}

TEST(Arc, UnderALimitOfTheTipsAccelerationTakesTheClosedFormsTime) {
  int compared = 0;
  for (const auto& c : cases_of("planner-arc-isotropic.json")) {
    const double r = c["radius_mm"], sweep = double(c["sweep_deg"]) * rad;
    const auto machine = identity_machine("XY", {{1e6, 1e9}, {1e6, 1e9}});
    machine->tip_acceleration_ = c["a_tcp"];
    Program program;
    program.feed(c["feed"]).arc(xyz(r * std::cos(sweep), r * std::sin(sweep), 0), 0, 0);
    const Planned planned = plan_program(*machine, joints_at(*machine, xyz(r, 0, 0)), program);
    const double t = c["t_acc_limited"];
    EXPECT_NEAR(planned.time(), t, 1e-3 * t) << c.dump();
    ++compared;
  }
  EXPECT_GE(compared, 6);
}

TEST(Line, UnderALimitOfTheTipsAccelerationKeepsIt) {
  const auto machine = mill();
  machine->tip_acceleration_ = 600;
  Program program;
  program.feed(50).line(xyz(40, 30, 0));
  EXPECT_NEAR(plan_program(*machine, zeros(*machine), program).time(), 1 + 50.0 / 600, 1e-9);
}

TEST(Circle, IsWithinAThousandthOfTheNumericOptimum) {
  for (const auto& c : cases_of("planner-circle-joint-box.json")) {
    const double r = c["radius_mm"];
    const auto machine =
        identity_machine("XY", {{c["v_max"][0], c["a_max"][0]}, {c["v_max"][1], c["a_max"][1]}});
    Program program;
    program.feed(c["feed"]).arc(xyz(r, 0, 0), 0, 0);
    const Planned planned = plan_program(*machine, joints_at(*machine, xyz(r, 0, 0)), program);
    const double t = c["t_acc_limited"];
    EXPECT_GT(planned.time(), t * (1 - 1e-3)) << c.dump();
    EXPECT_LT(planned.time(), t * (1 + 2e-3)) << c.dump();
  }
}

}  // namespace
}  // namespace aircut::plan
