// Programs that were measured on a real controller (acceleration limits only, 1 ms period).
// Exact-stop programs take its time within two periods per line; the others are no slower than it.
// Three of its programs need kinematics or commands that don't exist here (robot, delta, tap).
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/tiny_gcode.h"

namespace aircut::plan {
namespace {

using namespace test;

struct Peer {
  nlohmann::json data;
  std::shared_ptr<machine::Machine> machine;
  Planned planned;

  double seconds() const { return data["total_cycles"].get<double>() * 0.001; }
  /// Periods that the controller spent on lines, and on others (dwell and setup).
  double line_time(std::uint32_t line) const {
    double sum = 0;
    for (const Segment& segment : planned.segments)
      if (segment.command.block == line) sum += segment.duration();
    return sum;
  }
};

Peer plan_peer(const std::string& name) {
  static const nlohmann::json all = [] {
    std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/planner/planner-peer.json");
    return nlohmann::json::parse(in);
  }();
  Peer peer;
  for (const auto& c : all["cases"])
    if (c["name"] == name) peer.data = c;
  const std::string letters = peer.data["machine"] == "xyzac" ? "XYZAC" : "XYZ";
  std::vector<JointLimit> limits;
  for (const auto& limit : peer.data["joint_limits"])
    limits.push_back({limit["v_max"], limit["a_max"]});
  peer.machine = identity_machine(letters, limits);
  TinyGcode reader;
  const Program program = reader.read(peer.data["program"]);
  EXPECT_EQ(reader.problem, "");
  peer.planned = plan_program(*peer.machine, zeros(*peer.machine), program);
  EXPECT_TRUE(peer.planned.errors.empty());
  return peer;
}

TEST(Peer, ExactStopLinesTakeItsTimePerLine) {
  const Peer peer = plan_peer("t01_line");
  for (const auto& [line, cycles] : peer.data["cycles_per_line"].items()) {
    const int number = peer.data["cycles_per_line"][std::stoul(line)][0];
    if (number == 0) continue;
    const double seconds = peer.data["cycles_per_line"][std::stoul(line)][1].get<double>() * 1e-3;
    EXPECT_NEAR(peer.line_time(static_cast<std::uint32_t>(number)), seconds, 2.1e-3) << number;
  }
}

TEST(Peer, RotaryFeedRulesTakeItsTimePerLine) {
  const Peer peer = plan_peer("t08_rotary");
  int compared = 0;
  for (const auto& row : peer.data["cycles_per_line"]) {
    const int line = row[0];
    if (line == 0 || line > 9) continue;  // the rest is blended
    EXPECT_NEAR(peer.line_time(static_cast<std::uint32_t>(line)), row[1].get<double>() * 1e-3,
                2.1e-3)
        << line;
    ++compared;
  }
  EXPECT_GE(compared, 6);
}

class Others : public testing::TestWithParam<const char*> {};

TEST_P(Others, AreNoSlowerThanItInTotal) {
  const Peer peer = plan_peer(GetParam());
  RecordProperty("seconds", std::to_string(peer.planned.time()));
  EXPECT_LE(peer.planned.time(), peer.seconds() * 1.01);
}

INSTANTIATE_TEST_SUITE_P(Peer, Others,
                         testing::Values("t01_line", "t02_corner", "t03_arcs", "t04_dense",
                                         "t05_star", "t06_smallarcs", "t08_rotary", "t12_circles",
                                         "t13_lcorners"));

}  // namespace
}  // namespace aircut::plan
