// Random programs on every shipped machine, as it is and with jerk limits, every third one with
// overrides and holds, every fifth with rapids that are straight in the joints or doglegs, judged
// by the checker that reads nothing but the log, the limits and the programmed path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "logbook/logbook.h"
#include "support/run_log.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> packages() {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(AIRCUT_SOURCE_DIR "/machines"))
    if (fs::exists(entry.path() / "machine.toml")) out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

logbook::Point point(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// A program and the path that it asks for.
struct Written {
  Program program;
  std::vector<logbook::IdealPiece> pieces;
};

class Writer {
 public:
  Writer(const machine::Machine& machine, const AxisValues& home, unsigned seed)
      : axes_(machine.kinematics().axes()),
        straight_rapids_(plan::has_straight_rapids(machine, machine.kinematics())),
        home_(home),
        tip_(home),
        random_(seed) {}

  Written write(int moves, double size) {
    mode();
    for (int i = 0; i < moves; ++i) {
      if (random_() % 4 == 0) feed(5 + 60 * unit());
      switch (random_() % 6) {
        case 0:
          out_.program.rapid(somewhere(size, random_() % 3 == 0));
          piece(0);
          if (!straight_rapids_)
            out_.pieces.back().tolerance = std::numeric_limits<double>::infinity();
          break;
        case 1:
          arc(size);
          break;
        case 2:
          if (random_() % 4 == 0) out_.program.dwell(0.02 * unit());
          line(somewhere(0.02 * size, false));
          break;
        default:
          line(somewhere(size, random_() % 3 == 0));
      }
    }
    return std::move(out_);
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  void mode() {
    feed(30);
    switch (random_() % 5) {
      case 0:
        out_.program.exact_stop();
        break;
      case 1:
        out_.program.exact_path();
        break;
      default: {
        const double p = std::array{1e-6, 0.01, 0.1, 1.0}[random_() % 4];
        const double q = random_() % 2 ? p / 2 : 0;
        out_.program.blend(p).merge(q);
        tolerance_ = p + q;
      }
    }
  }
  void feed(double value) {
    feed_ = value;
    out_.program.feed(value);
  }
  AxisValues somewhere(double size, bool turns) {
    AxisValues to = tip_;
    for (const Axis axis : all_axes) {
      if (!axes_.has(axis)) continue;
      const double reach = is_rotary(axis) ? (turns ? 0.15 : 0) : size;
      if (reach > 0) to[axis] = home_[axis] + reach * (2 * unit() - 1);
    }
    return to;
  }
  void line(const AxisValues& to) {
    out_.program.line(to);
    piece(feed_);
  }
  // Half a turn or so in the plane of two axes that the machine has.
  void arc(double size) {
    const bool zx = !axes_.has(Axis::y);
    const Axis first = zx ? Axis::z : Axis::x, second = zx ? Axis::x : Axis::y;
    const double r = 0.3 * size * (0.1 + unit()), angle = 6.2 * unit(), way = 0.5 + 4 * unit();
    const int sense = random_() % 2 ? 1 : -1;
    AxisValues to = tip_;
    const double c1 = tip_[first] - r * std::cos(angle), c2 = tip_[second] - r * std::sin(angle);
    to[first] = c1 + r * std::cos(angle + sense * way);
    to[second] = c2 + r * std::sin(angle + sense * way);
    canon::ArcFeed command{to, zx ? Vec3(c2, 0, c1) : Vec3(c1, c2, 0),
                           zx ? Vec3::UnitY() : Vec3::UnitZ(), sense,
                           zx ? canon::Plane::zx : canon::Plane::xy};
    out_.program.add(command);
    piece(feed_);
    out_.pieces.back().arc = true;
    out_.pieces.back().centre = {command.centre.x(), command.centre.y(), command.centre.z()};
    out_.pieces.back().normal = {command.normal.x(), command.normal.y(), command.normal.z()};
    out_.pieces.back().turns = sense;
  }
  void piece(double feed) {
    const canon::Command& command = out_.program.commands().back();
    logbook::IdealPiece out;
    out.block = command.block;
    out.line = command.span.line;
    out.tolerance = tolerance_;
    out.feed = feed;
    out.start = point(tip_);
    tip_ = canon::end_of(command.action, tip_);
    out.end = point(tip_);
    out_.pieces.push_back(out);
  }

  AxisSet axes_;
  bool straight_rapids_;
  AxisValues home_, tip_;
  std::mt19937 random_;
  Written out_;
  double feed_ = 0, tolerance_ = 0;
};

// Somebody plays with the panel while a program of `seconds` runs.
std::vector<plan::OverrideEvent> random_events(double seconds, unsigned seed) {
  using What = plan::OverrideEvent::What;
  std::mt19937 random(seed);
  std::vector<plan::OverrideEvent> out;
  double t = 0;
  for (int i = 0; i < 4; ++i) {
    t += std::uniform_real_distribution<double>(0, seconds / 2)(random);
    const double factor = std::array{0.1, 0.5, 0.9, 1.3, 3.0}[random() % 5];
    switch (random() % 3) {
      case 0:
        out.push_back({t, What::feed, factor});
        break;
      case 1:
        out.push_back({t, What::rapid, std::min(factor, 1.0)});
        break;
      case 2:
        out.push_back({t, What::hold});
        out.push_back({t += 0.2, What::resume});
    }
  }
  return out;
}

// What the checker says against the log; nothing when the program leaves the machine's reach.
std::optional<std::string> judge(const std::shared_ptr<const machine::Machine>& machine,
                                 const Written& written, std::optional<unsigned> panel) {
  const machine::JointVector start = machine->home();
  Planned planned = plan_program(*machine, start, written.program);
  plan::Options options;
  if (panel && planned.errors.empty()) {
    options.overrides = random_events(planned.time(), *panel);
    planned = plan_program(*machine, start, written.program, options);
  }
  if (!planned.errors.empty()) return planned.errors.front();
  if (planned.segments.back().failure) return std::nullopt;
  for (const plan::Segment& segment : planned.segments)
    if (!segment.limit_problem.empty()) return segment.limit_problem;
  log::JointLogOptions log_options;
  log_options.feed_factors = plan::feed_factors(options.overrides);
  const SourceText log("log", run_to_log(machine, start, planned, log_options));
  std::size_t next = 0;
  const auto check = logbook::check(log, [&](logbook::IdealPiece& out) {
    if (next == written.pieces.size()) return false;
    out = written.pieces[next++];
    return true;
  });
  if (!check) return check.error().message;
  if (!check->problems.empty()) return check->problems.front();
  if (!check->unchecked.empty()) return "not checked: " + check->unchecked.front();
  for (const logbook::Peak& peak : check->peaks)
    if (peak.rows_over > 0)
      return peak.what + " of " + peak.joint + " is " + shortest(peak.share) +
             " of its limit, t = " + shortest(peak.t) + ", line " + std::to_string(peak.line);
  return "";
}

int number_from(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

// For a long search: AIRCUT_TEST_PROGRAMS programs a machine, from AIRCUT_TEST_SEED on.
class ShippedMachine : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedMachine, KeepsLimitsFeedAndPathOfRandomPrograms) {
  SourceMap sources;
  Diagnostics diagnostics;
  const auto package =
      machine::read_machine(AIRCUT_SOURCE_DIR "/machines/" + GetParam(), sources, diagnostics);
  ASSERT_TRUE(package);
  auto with_jerk = std::make_shared<machine::Machine>(**package);
  for (const int j : with_jerk->driven_) {
    machine::Joint& joint = with_jerk->tree_[static_cast<std::size_t>(j)];
    joint.jmax = joint.amax / 0.05;
  }
  const AxisValues home = *(*package)->kinematics().forward((*package)->home(), {});
  const int programs = number_from("AIRCUT_TEST_PROGRAMS", 6);
  int judged = 0;
  for (int i = 0; i < programs; ++i) {
    const auto seed = static_cast<unsigned>(number_from("AIRCUT_TEST_SEED", 0) + i);
    std::shared_ptr<const machine::Machine> machine = i % 2 ? with_jerk : *package;
    if (seed % 5 == 4 && machine->kinematics().passive_count() == 0) {
      auto other = std::make_shared<machine::Machine>(*machine);
      other->rapid_ = seed % 2 ? machine::RapidMode::joint : machine::RapidMode::dogleg;
      machine = other;
    }
    std::optional<std::string> wrong;
    // Where home is at the edge of the reach, nearer.
    for (double size = 10; size > 0.5 && !wrong; size /= 3)
      wrong = judge(machine, Writer(*machine, home, seed).write(6, size),
                    seed % 3 == 1 ? std::optional(seed) : std::nullopt);
    if (!wrong) continue;
    ++judged;
    EXPECT_EQ(*wrong, "") << GetParam() << ", seed " << seed << (i % 2 ? ", with jerk limits" : "");
  }
  RecordProperty("judged", judged);
  EXPECT_GE(judged, programs * 3 / 4) << "the others leave the reach";
}

INSTANTIATE_TEST_SUITE_P(Packages, ShippedMachine, ::testing::ValuesIn(packages()),
                         [](const auto& package) {
                           std::string name = package.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace aircut::test
