// The joint log, judged from its text alone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "support/log_checker.h"
#include "support/run_log.h"

namespace aircut::test {
namespace {

struct Case {
  std::shared_ptr<const machine::Machine> machine;
  AxisValues start;
  Program program;
  double tolerance = 0;  ///< P + Q
  bool ox = false;
  std::size_t around = 2;  ///< pieces compared to either side
  double busy = 0.99;      ///< share of some limit that must be used somewhere
};

void expect_good(const Case& c, const std::string& name) {
  const machine::JointVector start = joints_at(*c.machine, c.start);
  const Planned planned = plan_program(*c.machine, start, c.program);
  ASSERT_TRUE(planned.errors.empty()) << name << ": " << planned.errors.front();
  ASSERT_FALSE(planned.segments.back().failure) << planned.segments.back().failure->message;
  const JointLog log = read_log(run_to_log(c.machine, start, planned));
  ASSERT_TRUE(log.problems.empty()) << name << ": " << log.problems.front();
  ASSERT_GT(log.rows.size(), 10u);
  const Worst v = worst_velocity(log), a = worst_acceleration(log), f = worst_feed(log);
  EXPECT_LE(v.share, 1.001) << name << ": " << v.where;
  EXPECT_LE(a.share, 1.001) << name << ": " << a.where;
  EXPECT_LE(f.share, 1.001) << name << ": " << f.where;
  const Worst j = worst_jerk(log);
  EXPECT_LE(j.share, 1.001) << name << ": " << j.where;
  EXPECT_GT(std::max({v.share, a.share, f.share, j.share}), c.busy) << name << " crawls";
  const Worst d = worst_derivative(log);
  EXPECT_LE(d.share, 1.01) << name << ": " << d.where;
  const Worst path =
      worst_path_deviation(log, ideal_path(c.program, c.start, c.tolerance), c.around);
  EXPECT_LE(path.share, 1e-6) << name << ": " << path.where;
  if (c.ox) {
    const Worst rod = worst_rod_error(log);
    EXPECT_LE(rod.share, 1e-6) << name << ": " << rod.where;
  }
}

// Lines, arcs, rapids, dwells and feed changes around `middle`, no larger than `size`.
void add_random_moves(Program& program, std::mt19937& random, AxisValues tip, double size,
                      const Vec3& middle) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  program.feed(20 + 15 * uniform(random));
  const auto somewhere = [&] {
    return xyz(middle.x() + size * uniform(random), middle.y() + size * uniform(random),
               middle.z() + size * uniform(random));
  };
  for (int i = 0; i < 12; ++i) {
    switch (random() % 6) {
      case 0:
        program.rapid(tip = somewhere());
        break;
      case 1:
        program.dwell(0.01 + 0.02 * (1 + uniform(random)));
        break;
      case 2:
      case 3: {
        // A helix about a centre near the tip, ending on the other side.
        const double r = 0.3 * size * (1.1 + uniform(random));
        const double angle = 3.1 * uniform(random), to = angle + 3 * uniform(random) + 0.01;
        const double cx = tip[Axis::x] - r * std::cos(angle);
        const double cy = tip[Axis::y] - r * std::sin(angle);
        if (std::abs(cx - middle.x()) > 1.5 * size || std::abs(cy - middle.y()) > 1.5 * size) break;
        tip[Axis::x] = cx + r * std::cos(to);
        tip[Axis::y] = cy + r * std::sin(to);
        program.arc(tip, cx, cy, random() % 2 ? 1 : -1);
        break;
      }
      default:
        program.line(tip = somewhere());
    }
  }
  program.line(tip = somewhere());
}

// A program in each path mode in turn.
void add_random_program(Case& c, std::mt19937& random, int i, double size, const Vec3& middle) {
  if (i % 4 == 0) c.program.exact_stop();
  if (i % 4 == 1) c.program.exact_path();
  if (i % 4 >= 2) {
    const double p = i % 4 == 2 ? 0.02 : 0.8, q = i % 4 == 2 ? 0 : 0.4;
    c.program.blend(p).merge(q);
    c.tolerance = p + q;
  }
  add_random_moves(c.program, random, c.start, size, middle);
}

TEST(JointLog, KeepsLimitsFeedAndPathOfRandomProgramsOnAMill) {
  std::mt19937 random(1);
  for (int i = 0; i < 12; ++i) {
    Case c{mill(), {}, {}, 0, false};
    add_random_program(c, random, i, i % 3 == 0 ? 2 : 25, Vec3::Zero());
    expect_good(c, "mill program " + std::to_string(i));
  }
}

TEST(JointLog, KeepsLimitsFeedAndPathOfRandomProgramsOnAnOxGlide) {
  std::mt19937 random(2);
  for (int i = 0; i < 12; ++i) {
    Case c{ox_machine({60, 600}), xyz(250, 0, -320), {}, 0, true};
    add_random_program(c, random, i, i % 3 == 0 ? 4 : 20, Vec3(250, 0, -320));
    expect_good(c, "O-X program " + std::to_string(i));
  }
}

std::shared_ptr<machine::Machine> with_jerk(std::shared_ptr<machine::Machine> machine,
                                            double seconds) {
  for (const int j : machine->driven_) {
    machine::Joint& joint = machine->tree_[static_cast<std::size_t>(j)];
    joint.jmax = joint.amax / seconds;
  }
  return machine;
}

// For a long search: AIRCUT_TEST_PROGRAMS programs a test, from AIRCUT_TEST_SEED on.
int number_from(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}
unsigned seed_of(int i) { return static_cast<unsigned>(number_from("AIRCUT_TEST_SEED", 0) + i); }

TEST(JointLog, KeepsTheJerkLimitOfRandomProgramsOnAMill) {
  const int programs = number_from("AIRCUT_TEST_PROGRAMS", 4);
  for (int i = 0; i < programs; ++i) {
    std::mt19937 random(200 + seed_of(i));
    const double seconds = std::array{0.05, 0.02, 0.2}[random() % 3];
    Case c{with_jerk(mill(), seconds), {}, {}, 0, false};
    add_random_program(c, random, i, i % 3 == 0 ? 2 : 25, Vec3::Zero());
    expect_good(c, "mill program with jerk " + std::to_string(i));
  }
}

TEST(JointLog, KeepsTheJerkLimitOfRandomProgramsOnAnOxGlide) {
  const int programs = number_from("AIRCUT_TEST_PROGRAMS", 2);
  for (int i = 0; i < programs; ++i) {
    std::mt19937 random(300 + seed_of(i));
    Case c{with_jerk(ox_machine({60, 600}), 0.05), xyz(250, 0, -320), {}, 0, true};
    add_random_program(c, random, i, i % 3 == 0 ? 4 : 20, Vec3(250, 0, -320));
    expect_good(c, "O-X program with jerk " + std::to_string(i));
  }
}

TEST(JointLog, KeepsJerkLimitsOfAnySize) {
  const std::array seconds = {1e-4, 2e-3, 1.0, 20.0};  // from rest to the acceleration limit
  for (int i = 0; i < number_from("AIRCUT_TEST_PROGRAMS", 4); ++i) {
    std::mt19937 random(400 + seed_of(i));
    Case c{with_jerk(mill(), seconds[static_cast<std::size_t>(i) % 4]), {}, {}, 0, false};
    c.busy = 0.3;
    add_random_program(c, random, i / 4, 2, Vec3::Zero());
    expect_good(c, "program with a jerk limit of any size " + std::to_string(i));
  }
}

TEST(JointLog, KeepsAMuchLowerFeedFromItsBeginOn) {
  // Lengths of which the lower feed begins in the middle of a cell of the jerk stage.
  struct Slow {
    double way, feed, jerk;
  };
  for (const Slow& c : {Slow{3.12121, 0.3, 70000}, {3.06417, 1, 200000}, {3.34937, 3, 200000}}) {
    const auto machine = identity_machine("X", {{100, 3500, c.jerk}});
    Program program;
    program.exact_path().feed(90).line(xyz(c.way, 0, 0)).feed(c.feed).line(xyz(c.way + 0.1, 0, 0));
    const Planned planned = plan_program(*machine, zeros(*machine), program);
    const JointLog log = read_log(run_to_log(machine, zeros(*machine), planned));
    EXPECT_LE(worst_feed(log).share, 1.001) << worst_feed(log).where << ", way " << c.way;
    EXPECT_LE(worst_jerk(log).share, 1.001) << worst_jerk(log).where;
    EXPECT_LT(planned.time(), c.way / 90 + 0.1 / c.feed + 0.1);
  }
}

TEST(JointLog, KeepsLimitsWithTinyMovesAndTolerances) {
  const int programs = number_from("AIRCUT_TEST_PROGRAMS", 12);
  for (int i = 0; i < programs; ++i) {
    std::mt19937 random(100 + seed_of(i));
    std::uniform_real_distribution<double> uniform(-1, 1);
    const bool ox = i % 2 == 1;
    auto machine = ox ? ox_machine({60, 600}) : mill();
    if (i % 4 >= 2) machine = with_jerk(machine, 0.04);
    Case c{machine, ox ? xyz(250, 0, -320) : AxisValues{}, {}, 0, ox};
    const double step = std::pow(10.0, -1.5 + 2.5 * uniform(random));  // 1e-4 … 10 mm
    const double p = std::pow(10.0, -3 + 3 * uniform(random));         // 1e-6 … 1 mm
    const double q = i % 3 == 0 ? p / 2 : 0;
    c.tolerance = p + q;
    c.around = 60;
    c.busy = 0.3;  // much of it happens within a period
    c.program.blend(p).merge(q);
    double direction = 3 * uniform(random);
    AxisValues tip = c.start;
    for (int k = 0; k < 200; ++k) {
      if (k % 50 == 0) c.program.feed(20 + 15 * uniform(random));
      direction += 0.3 * uniform(random) + (k % 40 == 0 ? uniform(random) : 0);
      const double way = step * (1 + 0.8 * uniform(random));
      tip[Axis::x] += way * std::cos(direction);
      tip[Axis::y] += way * std::sin(direction);
      tip[Axis::z] += 0.1 * way * uniform(random);
      if (ox && (std::abs(tip[Axis::x] - 250) > 60 || std::abs(tip[Axis::z] + 320) > 25)) break;
      if (k % 30 == 29)
        c.program.rapid(tip);
      else
        c.program.line(tip);
    }
    expect_good(c, "tiny program " + std::to_string(i));
  }
}

TEST(JointLog, KeepsLimitsOfRotaryAxesInBlends) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 6; ++i) {
    Case c{identity_machine("XYZAC", {{100, 1000}, {100, 1000}, {50, 500}, {60, 600}, {90, 900}}),
           {},
           {},
           0.2,
           false};
    c.program.blend(0.2).feed(30);
    AxisValues tip;
    for (int k = 0; k < 30; ++k) {
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) tip[axis] += 5 * uniform(random);
      if (k % 3) tip[Axis::a] += 10 * rad * uniform(random);
      if (k % 5) tip[Axis::c] += 20 * rad * uniform(random);
      c.program.line(tip);
    }
    expect_good(c, "rotary program " + std::to_string(i));
  }
}

TEST(JointLog, KeepsLimitsWhereARodIsNearlyVertical) {
  // Rod 2 is vertical at Z -358: the slider's way per mm of Z grows without bound towards it.
  Case c{ox_machine({100, 1000}), xyz(250, 0, -300), {}, 0, true};
  c.program.exact_path()
      .feed(100)
      .line(xyz(250, 10, -357.9))
      .line(xyz(240, 10, -357.9))
      .rapid(xyz(260, 0, -320));
  expect_good(c, "towards the vertical rod");
}

TEST(JointLog, SaysTheHeaderAndTheColumnsOfTheFormat) {
  const auto machine = identity_machine("XC", {{100, 1000}, {60, 600}});
  Program program;
  program.feed(10).line(at({{Axis::x, 10}, {Axis::c, 30 * rad}}));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  log::JointLogOptions options;
  options.program = "a\nb.ngc";
  options.program_sha256 = "12ab";
  options.machine_sha256 = "34cd";
  const JointLog log = read_log(run_to_log(machine, zeros(*machine), planned, options));
  ASSERT_TRUE(log.problems.empty()) << log.problems.front();
  const std::vector<std::string> keys = {
      "format",       "program",        "program_sha256", "machine",    "machine_sha256",
      "kinematics",   "servo_period_s", "every",          "joints",     "linear_unit",
      "angular_unit", "limits_v",       "limits_a",       "limits_j",   "planner",
      "default_p_mm", "default_q_mm",   "start_pose",     "end_time_s", "samples"};
  EXPECT_EQ(log.header_order, keys);
  EXPECT_EQ(log.header.at("joints"), "X:mm,C:deg");
  EXPECT_EQ(log.header.at("limits_j"), "inf,inf");
  EXPECT_EQ(log.header.at("program").find('\n'), std::string::npos);
  const std::vector<std::string> columns = {
      "t",  "line", "block", "motion",      "feed_cmd",    "feed_act",   "s",    "q0", "q1", "v0",
      "v1", "a0",   "a1",    "x",           "y",           "z",          "a",    "b",  "c",  "u",
      "v",  "w",    "tool",  "spindle_rpm", "spindle_rev", "sync_error", "flags"};
  EXPECT_EQ(log.columns, columns);
  EXPECT_NEAR(log.end_time, 1.05, 1e-12);
  EXPECT_EQ(log.rows.size(), 1051u);
  const std::size_t middle = 525;
  EXPECT_NEAR(log.value(middle, "q1"), 15, 1e-9);
  EXPECT_NEAR(log.value(middle, "c"), 15, 1e-9);
  EXPECT_NEAR(log.value(middle, "v1"), 30, 1e-9);
  EXPECT_NEAR(log.value(middle, "feed_act"), 10, 1e-9);
  EXPECT_EQ(log.value(middle, "feed_cmd"), 10);
  EXPECT_EQ(log.value(middle, "motion"), 2);
  EXPECT_EQ(log.value(middle, "block"), 2);
  EXPECT_EQ(log.value(middle, "flags"), 4);
}

TEST(JointLog, CountsSpindleRevolutionsAndShowsTheTool) {
  const auto machine = mill();
  Program program;
  program.add(canon::ChangeTool{7}).add(canon::SetSpindleSpeed{0, 600});
  program.add(canon::TurnSpindle{0, canon::SpindleTurn::counterclockwise, true}).dwell(2);
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  const JointLog log = read_log(run_to_log(machine, zeros(*machine), planned));
  ASSERT_TRUE(log.problems.empty()) << log.problems.front();
  EXPECT_NEAR(log.end_time, 5, 1e-12);
  const std::size_t last = log.rows.size() - 1;
  EXPECT_EQ(log.value(last, "tool"), 7);
  EXPECT_EQ(log.value(last, "spindle_rpm"), -600);
  EXPECT_NEAR(log.value(last, "spindle_rev"), -20, 1e-9);
  EXPECT_EQ(log.value(1000, "motion"), 4);
  EXPECT_EQ(log.value(4000, "motion"), 6);
}

TEST(JointLog, ThinnedHasEveryNthRowAndTheLast) {
  const auto machine = mill();
  Program program;
  program.feed(50).line(xyz(50, 0, 0));
  const Planned planned = plan_program(*machine, zeros(*machine), program);
  const JointLog all = read_log(run_to_log(machine, zeros(*machine), planned));
  log::JointLogOptions options;
  options.every = 100;
  const JointLog thin = read_log(run_to_log(machine, zeros(*machine), planned, options));
  ASSERT_EQ(thin.rows.size(), 12u);
  for (std::size_t k = 0; k < 11; ++k) EXPECT_EQ(thin.rows[k], all.rows[100 * k]);
  EXPECT_EQ(thin.rows.back(), all.rows.back());
}

TEST(JointLog, IsTheSameTextEveryTime) {
  const auto machine = ox_machine();
  Program program;
  program.feed(50)
      .line(xyz(260, 20, -330))
      .arc(xyz(240, 20, -330), 250, 20)
      .rapid(xyz(250, 0, -300));
  const machine::JointVector start = joints_at(*machine, xyz(250, 0, -300));
  const std::string first = run_to_log(machine, start, plan_program(*machine, start, program));
  EXPECT_GT(first.size(), 10000u);
  EXPECT_EQ(first, run_to_log(machine, start, plan_program(*machine, start, program)));
}

TEST(JointLog, InAMissingFolderIsAnError) {
  const auto machine = mill();
  const auto log = log::CsvJointLog::create("/nowhere/at/all/joints.csv", *machine, {});
  ASSERT_FALSE(log);
  EXPECT_EQ(log.error().kind, "output_failed");
}

}  // namespace
}  // namespace aircut::test
