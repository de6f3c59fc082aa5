// The planner as a whole: corners, look-ahead, invariances, failures.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "support/plan_machines.h"

namespace aircut::plan {
namespace {

using namespace test;

double time_of(const machine::Machine& machine, const Program& program,
               const AxisValues& start = {}) {
  const Planned planned = plan_program(machine, joints_at(machine, start), program);
  EXPECT_TRUE(planned.errors.empty()) << planned.errors.front();
  return planned.time();
}

std::string text_of(const Planned& planned) {
  std::string out;
  for (const Segment& segment : planned.segments) {
    out += std::to_string(segment.command.block) + " " + std::string(to_string(segment.kind)) +
           " " + shortest(segment.t_start);
    for (const ProfileKnot& k : segment.profile.knots)
      out += " " + shortest(k.t) + "," + shortest(k.s) + "," + shortest(k.v) + "," + shortest(k.a);
    out += "\n";
  }
  return out;
}

// ---- traps of other planners -----------------------------------------------------------------

TEST(Trap, AHairOfWayBesideALargeTurnCountsAsATurn) {
  const auto machine = identity_machine("XA", {{100, 1000}, {60, 600}});
  const double turn = time_of(*machine, Program().feed(30).line(at({{Axis::a, 100 * rad}})));
  const double both =
      time_of(*machine, Program().feed(30).line(at({{Axis::x, 5e-9}, {Axis::a, 100 * rad}})));
  EXPECT_NEAR(both, turn, 1e-9 * turn);
  EXPECT_NEAR(turn, 100.0 / 30 + 30.0 / 600, 1e-9);
}

TEST(Trap, SegmentsOfATenthOfAMicrometreTakeTheTimeOfTheWholeLine) {
  const auto machine = mill();
  Program whole, pieces;
  whole.blend(0.01).feed(50).line(xyz(0.2, 0.1, 0));
  pieces.blend(0.01).feed(50);
  for (int i = 1; i <= 2000; ++i) pieces.line(xyz(1e-4 * i, 0.5e-4 * i, 0));
  const double t = time_of(*machine, whole);
  EXPECT_NEAR(time_of(*machine, pieces), t, 1e-4 * t);
}

TEST(Trap, ABlendIsNoRounderForAFeedThatNobodyAskedFor) {
  const auto machine = mill();
  const auto cut = [&](double feed) {
    const Planned planned =
        plan_program(*machine, zeros(*machine),
                     Program().blend(0).feed(feed).line(xyz(50, 0, 0)).line(xyz(50, 50, 0)));
    double length_of_blend = 0;
    for (const Segment& segment : planned.segments)
      if (segment.kind == MotionKind::blend) length_of_blend += length(segment.path);
    return length_of_blend;
  };
  EXPECT_GT(cut(5), 0);
  EXPECT_NEAR(cut(10) / cut(5), 4, 0.3) << "size goes with the square of the feed";
}

// ---- corners ---------------------------------------------------------------------------------

TEST(Corner, BlendsAreNoSlowerThanTheVectorsAndStayWithinP) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/planner/planner-corner.json");
  const nlohmann::json cases = nlohmann::json::parse(in)["cases"];
  for (const auto& c : cases) {
    const double turn = c["turn_deg"].get<double>() * rad, p = c["tolerance_mm"];
    const double first = c["lengths_mm"][0], second = c["lengths_mm"][1];
    const auto machine =
        identity_machine("XY", {{c["v_max"][0], c["a_max"][0]}, {c["v_max"][1], c["a_max"][1]}});
    Program program;
    program.blend(p).feed(c["feed"]).line(xyz(first, 0, 0));
    program.line(xyz(first + second * std::cos(turn), second * std::sin(turn), 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    EXPECT_LE(planned.time(), c["t_blend_acc"].get<double>() * 1.002) << c.dump();
    // No faster than a legal blend can be: the corner cut by P shortens the way only that much.
    EXPECT_GE(planned.time(), c["t_blend_acc"].get<double>() * 0.98) << c.dump();
    double off = 0;
    for (const Segment& segment : planned.segments)
      if (const auto* blend = std::get_if<Blend>(&segment.path))
        for (int k = 0; k <= 100; ++k) {
          const AxisValues tip = evaluate(*blend, blend->length * k / 100).p;
          const Vec3 v(tip[Axis::x], tip[Axis::y], 0);
          const Vec3 u(std::cos(turn), std::sin(turn), 0), corner(first, 0, 0);
          const double to_first = std::abs(v.y());
          const double to_second = ((v - corner) - (v - corner).dot(u) * u).norm();
          off = std::max(off, std::min(to_first, to_second));
        }
    EXPECT_LE(off, p * (1 + 1e-9));
    EXPECT_GT(off, 0);
  }
}

TEST(Corner, IsAStopInExactPathMode) {
  const auto machine = mill();
  Program program;
  program.exact_path().feed(50).line(xyz(50, 0, 0)).line(xyz(50, 50, 0));
  EXPECT_NEAR(time_of(*machine, program), 2.1, 1e-9);
}

TEST(Corner, ThatGoesBackIsAStop) {
  const auto machine = mill();
  Program program;
  program.blend(0.5).feed(50).line(xyz(50, 0, 0)).line(xyz(0, 0, 0));
  EXPECT_NEAR(time_of(*machine, program), 2.1, 1e-9);
}

TEST(Corner, WithATinyToleranceIsHardlyFasterThanAStopAndNeverSlower) {
  const auto machine = mill();
  double last = 2.1 * (1 + 1e-9);
  for (const double p : {1e-6, 1e-4, 1e-2, 0.1, 1.0, 5.0, 0.0}) {  // 0 = no limit
    Program program;
    program.blend(p).feed(50).line(xyz(50, 0, 0)).line(xyz(50, 50, 0));
    const double t = time_of(*machine, program);
    EXPECT_LE(t, last * (1 + 1e-3)) << p;
    last = t;
  }
  EXPECT_GT(last, 1.9);
}

TEST(Corner, IsNoRounderThanTheFeedNeeds) {
  const auto machine = mill();
  const auto cut = [&](double feed) {
    Program program;
    program.blend(0).feed(feed).line(xyz(50, 0, 0)).line(xyz(50, 50, 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    for (const Segment& segment : planned.segments)
      if (segment.kind == MotionKind::blend) return (1 - segment.u0) * 50;
    return 0.0;
  };
  // A fillet that is passed at v needs a radius v² / a: rounding grows with the square.
  EXPECT_GT(cut(10), 0);
  EXPECT_NEAR(cut(20) / cut(10), 4, 0.1);
  EXPECT_LT(cut(10), 1);
}

TEST(Corner, OfArcAndLineThatTouchIsPassedAtSpeed) {
  const auto machine = mill();
  Program passed, stopped;
  for (Program* program : {&passed, &stopped}) {
    if (program == &passed)
      program->exact_path();
    else
      program->exact_stop();
    program->feed(30).line(xyz(30, 0, 0)).arc(xyz(30, 40, 0), 30, 20).line(xyz(0, 40, 0));
  }
  const double length = 60 + 20 * std::numbers::pi;
  EXPECT_NEAR(time_of(*machine, passed), length / 30 + 0.03, 1e-3);
  EXPECT_GT(time_of(*machine, stopped), length / 30 + 3 * 0.03 - 1e-3);
}

TEST(Corner, BetweenArcsStaysNearBothAndGoesOn) {
  const auto machine = mill();
  Program blended, stopped;
  for (Program* program : {&blended, &stopped}) {
    if (program == &blended)
      program->blend(0.05);
    else
      program->exact_stop();
    program->feed(30).arc(xyz(10, 0, 0), 5, 0, -1).arc(xyz(20, 0, 0), 15, 5, 1);
  }
  const double t = time_of(*machine, blended);
  EXPECT_LT(t, time_of(*machine, stopped) - 0.005);
}

// ---- look-ahead ------------------------------------------------------------------------------

Program zigzag(int n, double step, double p) {
  Program program;
  program.blend(p).feed(40);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double x = 0, y = 0;
  for (int i = 0; i < n; ++i) {
    x += step;
    y += 0.3 * step * uniform(random);
    program.line(xyz(x, y, 0));
  }
  return program;
}

TEST(LookAhead, GivesTheSameSegmentsHoweverTheyAreFetched) {
  const auto machine = mill();
  const Program program = zigzag(3000, 0.2, 0.05);
  const Planned at_once = plan_program(*machine, zeros(*machine), program);
  // Nothing is fetched before the end.
  Planner planner(*machine, zeros(*machine), {});
  for (const canon::Command& command : program.commands()) ASSERT_TRUE(planner.push(command));
  planner.flush();
  Planned late;
  while (auto segment = planner.take()) late.segments.push_back(std::move(*segment));
  EXPECT_TRUE(text_of(at_once) == text_of(late));
}

TEST(LookAhead, GivesTheSameTimesForEveryWindowThatCoversTheBraking) {
  const auto machine = mill();
  const Program program = zigzag(2000, 0.2, 0.05);
  std::string reference;
  for (const std::size_t window : {3000u, 20000u, 1000000u}) {
    Options options;
    options.max_nodes = window;
    const Planned planned = plan_program(*machine, zeros(*machine), program, options);
    if (reference.empty()) reference = text_of(planned);
    EXPECT_TRUE(text_of(planned) == reference) << window;
  }
}

TEST(LookAhead, HandsOutSegmentsLongBeforeTheEnd) {
  const auto machine = mill();
  const Program program = zigzag(4000, 0.5, 0.05);
  Planner planner(*machine, zeros(*machine), {});
  std::uint64_t out = 0, most = 0;
  for (const canon::Command& command : program.commands()) {
    ASSERT_TRUE(planner.push(command));
    while (auto segment = planner.take()) out = segment->command.block;
    most = std::max(most, command.block - out);
  }
  EXPECT_LT(most, 100u);
}

TEST(LookAhead, WithATooSmallWindowIsSlowerButLegal) {
  const auto machine = mill();
  const Program program = zigzag(500, 0.01, 0.001);
  Options options;
  options.max_nodes = 20;
  const Planned small = plan_program(*machine, zeros(*machine), program, options);
  const Planned large = plan_program(*machine, zeros(*machine), program);
  EXPECT_GE(small.time(), large.time());
  EXPECT_LT(small.time(), 20 * large.time());
}

// ---- invariances (planner rule 9.7, 9.8) -------------------------------------------------------

Program mixed_path(const std::vector<Axis>& order, double scale, double feed) {
  const auto put = [&](double a, double b) {
    return at({{order[0], scale * a}, {order[1], scale * b}});
  };
  Program program;
  program.blend(0.1 * scale).feed(feed);
  return program.line(put(30, 0)).line(put(30, 20)).line(put(10, 35)).line(put(0, 0));
}

TEST(Invariance, SplittingALineChangesNothing) {
  const auto machine = mill();
  Program whole, split;
  whole.exact_path().feed(50).line(xyz(37, 21, 9));
  split.exact_path().feed(50);
  for (int i = 1; i <= 1000; ++i) split.line(xyz(37 * i / 1000.0, 21 * i / 1000.0, 9 * i / 1000.0));
  const double t = time_of(*machine, whole);
  EXPECT_NEAR(time_of(*machine, split), t, 1e-6 * t);
}

TEST(Invariance, ReversingAPathTakesTheSameTime) {
  const auto machine = mill();
  const std::vector<AxisValues> points = {xyz(0, 0, 0), xyz(20, 5, 0), xyz(25, 30, -3),
                                          xyz(-4, 18, 2)};
  Program there, back;
  there.blend(0.2).feed(60);
  back.blend(0.2).feed(60);
  for (std::size_t i = 1; i < points.size(); ++i) there.line(points[i]);
  for (std::size_t i = points.size() - 1; i-- > 0;) back.line(points[i]);
  const double t = time_of(*machine, there);
  EXPECT_NEAR(time_of(*machine, back, points.back()), t, 1e-4 * t);
}

TEST(Invariance, ScalingSpeedsDividesTheTime) {
  Program slow = mixed_path({Axis::x, Axis::y}, 1, 20);
  Program fast = mixed_path({Axis::x, Axis::y}, 1, 60);
  const auto machine = identity_machine("XYZ", {{50, 300}, {50, 300}, {50, 300}});
  const auto quick = identity_machine("XYZ", {{150, 2700}, {150, 2700}, {150, 2700}});
  const double t = time_of(*machine, slow);
  EXPECT_NEAR(time_of(*quick, fast), t / 3, 1e-9 * t);
}

TEST(Invariance, PermutingAxesOrMovingTheStartChangesNothing) {
  const auto machine = identity_machine("XYZ", {{50, 300}, {50, 300}, {50, 300}});
  const double t = time_of(*machine, mixed_path({Axis::x, Axis::y}, 1, 30));
  EXPECT_NEAR(time_of(*machine, mixed_path({Axis::z, Axis::x}, 1, 30)), t, 1e-9 * t);
  Program moved;
  moved.blend(0.1).feed(30).line(xyz(130, 50, 7)).line(xyz(130, 70, 7)).line(xyz(110, 85, 7));
  moved.line(xyz(100, 50, 7));
  EXPECT_NEAR(time_of(*machine, moved, xyz(100, 50, 7)), t, 1e-9 * t);
}

TEST(Monotone, MoreOfAnyLimitIsNeverSlower) {
  const Program program = mixed_path({Axis::x, Axis::y}, 1, 45);
  double last = std::numeric_limits<double>::infinity();
  for (const double a : {100.0, 150.0, 220.0, 400.0, 900.0, 2500.0}) {
    const auto machine = identity_machine("XYZ", {{50, a}, {50, 1.3 * a}, {50, a}});
    const double t = time_of(*machine, program);
    EXPECT_LE(t, last * 1.001) << a;
    last = t;
  }
}

TEST(Monotone, ALargerToleranceIsNeverSlower) {
  for (const double jerk : {std::numeric_limits<double>::infinity(), 20000.0}) {
    const auto machine =
        identity_machine("XYZ", {{50, 900, jerk}, {50, 700, jerk}, {50, 900, jerk}});
    double last = std::numeric_limits<double>::infinity();
    for (const double p : {1e-4, 1e-3, 0.01, 0.05, 0.2, 1.0}) {
      Program program;
      program.blend(p).feed(40);
      for (int i = 1; i <= 12; ++i) program.line(xyz(3.0 * i, i % 2 ? 4 : 0, i % 3));
      const double t = time_of(*machine, program);
      EXPECT_LE(t, last * 1.001) << p << ", jerk " << jerk;
      last = t;
    }
  }
}

// ---- merging ---------------------------------------------------------------------------------

TEST(Merge, ReplacesLinesByTheirChordAndKeepsTheirNames) {
  const auto machine = mill();
  Program program;
  program.blend(0.01).merge(0.005).feed(50);
  for (int i = 1; i <= 50; ++i) program.line(xyz(0.5 * i, i % 2 ? 0.004 : 0, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  EXPECT_NEAR(planned.time(), 25.0 / 50 + 0.05, 1e-3);
  std::vector<std::uint64_t> blocks;
  for (const Segment& segment : planned.segments)
    if (segment.merged) blocks.push_back(segment.command.block);
  ASSERT_EQ(blocks.size(), 50u);
  for (std::size_t i = 0; i < blocks.size(); ++i) EXPECT_EQ(blocks[i], 4 + i);
}

TEST(Merge, IsOffWithoutQ) {
  const auto machine = mill();
  Program program;
  program.blend(0.01).feed(50).line(xyz(1, 0, 0)).line(xyz(2, 0.001, 0));
  for (const Segment& segment : plan_program(*machine, zeros(*machine), program).segments)
    EXPECT_FALSE(segment.merged);
}

// ---- other kinematics ------------------------------------------------------------------------

TEST(OxGlide, CapsOfNearlyVerticalRodsSlowThePath) {
  const auto machine = ox_machine({100, 1000});
  Program program;
  program.exact_path().feed(100).line(xyz(250, 0, -357.99));
  const Planned planned = plan_program(*machine, joints_at(*machine, xyz(250, 0, -300)), program);
  ASSERT_FALSE(planned.segments.back().failure);
  // Slider 2 moves sqrt(l² − u²) and has to come to rest where 1 mm of Z is 65 mm of slider.
  EXPECT_GT(planned.time(), 57.99 / 100 + 0.1);
}

TEST(Failure, StopsAtTheLastReachablePlace) {
  const auto machine = ox_machine();
  Program program;
  program.exact_path().feed(50).line(xyz(250, 0, -350)).line(xyz(250, 0, -370));
  program.line(xyz(250, 0, -300)).dwell(1);
  const Planned planned = plan_program(*machine, joints_at(*machine, xyz(250, 0, -300)), program);
  ASSERT_FALSE(planned.segments.empty());
  const Segment& last = planned.segments.back();
  ASSERT_TRUE(last.failure);
  EXPECT_EQ(last.command.block, 4u);
  EXPECT_EQ(last.failure->kind, "unreachable");
  EXPECT_NE(last.failure->message.find("rod 2"), std::string::npos) << last.failure->message;
  // Rod 2 is vertical at Z -358, 8 mm of 20.
  EXPECT_NEAR(last.failure->fraction, 0.4, 2e-6);
  EXPECT_NEAR(last.failure->pose[Axis::z], -358, 4e-5);
  EXPECT_EQ(last.profile.knots.back().v, 0);
  EXPECT_NEAR(evaluate(last.path, length(last.path)).p[Axis::z], -358, 4e-5);
}

TEST(Failure, IsFoundInsideAMoveWhoseEndsAreReachable) {
  const auto machine = ox_machine();
  Program program;
  // The lower half circle dips below Z -358 between two good ends.
  canon::ArcFeed dip{xyz(270, 0, -350), Vec3(250, 0, -350), Vec3(0, 1, 0), -1, canon::Plane::zx};
  program.feed(50).add(dip);
  const Planned planned = plan_program(*machine, joints_at(*machine, xyz(230, 0, -350)), program);
  ASSERT_TRUE(planned.segments.back().failure);
  EXPECT_NEAR(planned.segments.back().failure->pose[Axis::z], -358, 1e-3);
  EXPECT_LT(planned.segments.back().failure->fraction, 0.5);
}

TEST(Failure, AtTheVeryStartOfAMoveStillNamesIt) {
  const auto machine = ox_machine();
  Program program;
  program.add(canon::ToolLengthOffset{xyz(0, 0, 10)});
  program.feed(50).line(xyz(250, 0, -400));
  const Planned planned =
      plan_program(*machine, joints_at(*machine, xyz(250, 0, -357.99)), program);
  ASSERT_TRUE(planned.segments.back().failure);
  EXPECT_EQ(planned.segments.back().command.block, 3u);
  EXPECT_NEAR(planned.segments.back().failure->fraction, 0.01 / 32.01, 2e-6);
}

TEST(Start, WithoutAPositionIsAnError) {
  const auto machine = ox_machine();
  machine::JointVector start(3);
  start << 0, 5000, 0;
  Program program;
  program.rapid(xyz(250, 0, -300));
  const Planned planned = plan_program(*machine, start, program);
  ASSERT_EQ(planned.errors.size(), 1u);
  EXPECT_TRUE(planned.errors[0].starts_with("unreachable")) << planned.errors[0];
}

}  // namespace
}  // namespace aircut::plan
