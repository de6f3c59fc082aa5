// One machine or more of every kinematics type, with a box of poses that it reaches. The contract
// tests loop over them; a row of the kinematics table without a sample fails.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "base/random.h"
#include "machine/kinematics/chain.h"
#include "machine/kinematics/kinematics_table.h"
#include "machine/machine.h"

namespace aircut::machine {

struct Sample {
  std::string name;
  std::shared_ptr<const Kinematics> kinematics;
  AxisValues low, high;              ///< tip poses, all reachable; mm and rad
  JointVector near = JointVector();  ///< starts the search; empty: all zero
  bool bounded = true;               ///< travel bounds of large boxes, too
  bool tools = true;                 ///< takes a tool length along Z
  /// How far a value may turn back within 0.01 mm, where its slope is zero.
  double turning = 1e-9;

  int ways = 300, steps = 2000;  ///< how many random ways, and steps on each, bound its travel
  double rounding = 1e-9;        ///< of a value's way over all steps

  JointVector start() const {
    return near.size() > 0 ? near : JointVector::Zero(kinematics->joint_count());
  }
};

/// A kinematics by its type, as a package's `[kinematics]` table makes it; with `drawn` the package
/// has couples for the rods.
inline std::shared_ptr<const Kinematics> of_type(const std::string& type,
                                                 const std::vector<std::string>& parameters = {},
                                                 bool drawn = false) {
  SourceMap sources;
  Diagnostics out;
  auto bare = bare_machine(type, parameters, sources, out);
  for (const Diagnostic& d : out.list()) ADD_FAILURE() << type << ": " << d.message;
  if (!bare) return nullptr;
  if (!drawn) return (*bare)->kinematics_;
  Machine machine = **bare;
  machine.tree_.emplace_back();
  machine.tree_.back().passive = "rod";
  const std::string text = "type = \"" + type + "\"\n";
  const SourceText& source = sources.add("drawn", text);
  config::Reader reader(source, "usage");
  config::Table table = reader.top();
  for (const KinematicsRow& row : kinematics_table()) {
    if (row.type != type) continue;
    const std::span<const Joint> driven((*bare)->tree_);
    KinematicsInput input{table, 1.0, driven, machine};
    return row.make(input);
  }
  return nullptr;
}

inline AxisValues axis_values(double x, double y, double z, double a = 0, double b = 0,
                              double c = 0) {
  AxisValues v;
  v.value = {x, y, z, a, b, c, 0, 0, 0};
  return v;
}

/// A trunnion table A with a turntable C on it, off its axis (table/table).
inline std::shared_ptr<const Kinematics> sample_trunnion() {
  ChainGeometry g;
  g.work = {{JointKind::linear, Vec3::Zero(), Vec3::UnitY(), -1, 1},
            {JointKind::rotary, Vec3(0, 10, 40), Vec3::UnitX(), -1, 3},
            {JointKind::rotary, Vec3(3, -4, 0), Vec3::UnitZ(), -1, 4}};
  g.tool = {{JointKind::linear, Vec3::Zero(), Vec3::UnitZ(), 1, 2},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitX(), 1, 0}};
  g.words = {Axis::x, Axis::y, Axis::z, Axis::a, Axis::c};
  g.X_LM.translation() = Vec3(0, 0, 30);
  g.gauge = Vec3(0, 0, 400);
  std::string reason;
  return make_chain(g, reason);
}

/// A nutating head B at 45° that turns about C, on a slide that leans: nothing is orthogonal.
inline std::shared_ptr<const Kinematics> sample_nutating_head() {
  ChainGeometry g;
  g.work = {{JointKind::linear, Vec3::Zero(), Vec3::UnitX(), -1, 0}};
  g.tool = {{JointKind::linear, Vec3::Zero(), Vec3(0, 1, 0.1).normalized(), 1, 1},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitZ(), 1, 2},
            {JointKind::rotary, Vec3(5, 0, 600), Vec3::UnitZ(), 1, 3},
            {JointKind::rotary, Vec3(5, 20, 550), Vec3(0, 1, 1).normalized(), 1, 4}};
  g.words = {Axis::x, Axis::y, Axis::z, Axis::c, Axis::b};
  g.gauge = Vec3(0, 0, 400);
  std::string reason;
  return make_chain(g, reason);
}

/// A turntable C under the slide Y, so that Y turns with it, and a head A.
inline std::shared_ptr<const Kinematics> sample_turning_slide() {
  ChainGeometry g;
  g.work = {{JointKind::rotary, Vec3(20, 10, 0), Vec3::UnitZ(), -1, 3},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitY(), -1, 1}};
  g.tool = {{JointKind::linear, Vec3::Zero(), Vec3::UnitX(), 1, 0},
            {JointKind::linear, Vec3::Zero(), Vec3::UnitZ(), 1, 2},
            {JointKind::rotary, Vec3(0, 0, 600), Vec3::UnitX(), 1, 4}};
  g.words = {Axis::x, Axis::y, Axis::z, Axis::c, Axis::a};
  g.gauge = Vec3(0, 0, 400);
  std::string reason;
  return make_chain(g, reason);
}

inline JointVector joint_values(std::initializer_list<double> values) {
  JointVector q(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), q.data());
  return q;
}

/// The catalogue of machines.
inline std::vector<Sample> catalogue() {
  constexpr double deg = std::numbers::pi / 180;
  const auto xyz = [](double x, double y, double z) { return axis_values(x, y, z); };
  const auto five = [&](double x, double y, double z, double a, double b, double c = 0) {
    return axis_values(x, y, z, a * deg, b * deg, c * deg);
  };
  const double turns = 2e-6;
  std::vector<Sample> all = {
      {"calibrated",
       of_type("calibrated",
               {"matrix = [1, 0.01, 0, -0.02, 1.001, 0, 0.003, 0, 0.999]", "offset = [1, 2, 3]"}),
       xyz(-200, -150, -300), xyz(200, 150, 0)},
      {"corexy", of_type("corexy"), xyz(-200, -150, -300), xyz(200, 150, 0)},
      {"corexy, XZ", of_type("corexy", {"pair = \"XZ\""}), xyz(-200, -150, -300), xyz(200, 150, 0)},
      {"gantry", of_type("gantry", {"axis = \"Y\"", "span = 900"}), xyz(-200, -150, -300),
       xyz(200, 150, 0)},
      {"polar", of_type("polar"), xyz(20, -150, -300), xyz(200, 150, 0)},
      {"rotated-xy", of_type("rotated-xy"), five(-200, -150, -300, 0, 0, -170),
       five(200, 150, 0, 0, 0, 170)},
      {"plotter", of_type("plotter", {}, true), xyz(100, -700, -5), xyz(900, -150, 40)},
      {"biglide", of_type("biglide", {}, true), xyz(100, -50, -350), xyz(300, 50, -150)},
      {"five-bar", of_type("five-bar"), xyz(-80, 280, -20), xyz(80, 400, 20)},
      {"tripod", of_type("tripod", {}, true), xyz(350, 150, 400), xyz(600, 450, 900)},
      {"tripod, hanging", of_type("tripod", {"root = \"lower\""}), xyz(350, 150, -900),
       xyz(600, 450, -400)},
      {"tripod-inverted", of_type("tripod-inverted", {}, true),
       five(350, 150, -900, -40, -40, -400), five(600, 450, -400, 40, 40, 400)},
      {"triglide", of_type("triglide", {}, true), xyz(-200, -60, -420), xyz(200, 60, -300)},
      {"delta-linear", of_type("delta-linear", {}, true), xyz(-60, -60, -100), xyz(60, 60, 100)},
      {"delta-rotary", of_type("delta-rotary"), xyz(-60, -60, -420), xyz(60, 60, -300)},
      {"hexapod", of_type("hexapod", {}, true), five(-60, -60, -680, -15, -15, -15),
       five(60, 60, -560, 15, 15, 15)},
      {"hexapod, off centre", of_type("hexapod", {"gauge = [10, -20, -90]"}),
       five(-60, -60, -780, -15, -15, -15), five(60, 60, -660, 15, 15, 15)},
      {"hexaglide", of_type("hexaglide", {}, true), five(-40, -40, -450, -12, -12, -12),
       five(40, 40, -350, 12, 12, 12)},
      {"pentapod", of_type("pentapod"), five(-60, -60, -60, -12, -12), five(60, 60, 60, 12, 12)},
      {"scara", of_type("scara"), five(150, 100, 100, 0, 0, -300), five(350, 250, 400, 0, 0, 300)},
      {"scorbot", of_type("scorbot"), five(150, -150, 60, -90, -90), five(300, 150, 250, 90, 90)},
      {"scorbot, differential", of_type("scorbot", {"differential = true"}),
       five(150, -150, 60, -90, -90), five(300, 150, 250, 90, 90)},
      {"lathe-vertical", of_type("lathe-vertical"), xyz(40, -150, 100), xyz(300, 150, 400)},
      {"lathe-vertical, beside the axis", of_type("lathe-vertical", {"e = 14.738"}),
       xyz(-300, -150, 100), xyz(-40, 150, 400), joint_values({-500, 0, 0})},
      {"puma", of_type("puma"), five(250, 50, -250, 150, -25, -25),
       five(400, 250, -50, 178, 25, 25), joint_values({0, 0, -2.4, 0, 1, 0})},
      {"three21", of_type("three21"), five(260, 60, 140, 150, -15, -25),
       five(330, 140, 220, 165, 15, 25), joint_values({0, -1, 0.4, 0, 1, 0})},
      {"serial", of_type("serial"), five(250, 50, -250, -28, -25, -25),
       five(400, 250, -50, -2, 25, 25), joint_values({0.4, -1, 0.4, 0.1, 0.7, 0.1})},
      {"serial, five joints",
       of_type("serial", {"dh = [[0, 0, 0, 0], [0, 0, 0, -90], [0, 70, 300, 0], [0, 400, 50, -90], "
                          "[0, 0, 0, 90]]",
                          "convention = \"modified\"", "tool = [0, 70, 0, 90, 0, 0]"}),
       five(250, 50, -250, -28, -25), five(400, 250, -50, -2, 25),
       joint_values({0.4, -1, 0.4, 0.1, 0.7})},
      {"serial, with a slide",
       of_type("serial", {"dh = [[0, 490, 340, 0], [0, 0, 250, 180], [0, 0, 0, 0]]",
                          "kinds = \"RRT\"", "convention = \"standard\""}),
       xyz(250, 100, 100), xyz(400, 250, 400), joint_values({0.1, 1, 200})},
      {"four-axis", of_type("four-axis", {"axis = \"B\"", "point1 = [10, 0, -80]"}),
       five(-200, -150, -300, 0, -170), five(200, 150, 0, 0, 170)},
      {"table-ac", of_type("table-ac", {"point1 = [0, 5, -60]"}),
       five(-200, -150, -300, -100, 0, -170), five(200, 150, 0, 100, 0, 170)},
      {"table-bc", of_type("table-bc"), five(-200, -150, -300, 0, -100, -170),
       five(200, 150, 0, 0, 100, 170)},
      {"table-ab", of_type("table-ab"), five(-200, -150, -300, -100, -170),
       five(200, 150, 0, 100, 170)},
      {"head-ab", of_type("head-ab"), five(-200, -150, -300, -100, -100),
       five(200, 150, 0, 100, 100)},
      {"head-ca", of_type("head-ca"), five(-200, -150, -300, -100, 0, -170),
       five(200, 150, 0, 100, 0, 170)},
      {"head-cb, nutating", of_type("head-cb", {"direction2 = [0.6, 0, 0.8]"}),
       five(-200, -150, -300, 0, -100, -170), five(200, 150, 0, 0, 100, 170)},
      {"head-a-table-c", of_type("head-a-table-c"), five(-200, -150, -300, -100, 0, -170),
       five(200, 150, 0, 100, 0, 170)},
      {"head-b-table-c", of_type("head-b-table-c"), five(-200, -150, -300, 0, -100, -170),
       five(200, 150, 0, 0, 100, 170)},
  };
  for (Sample& sample : all) {
    sample.turning = turns;
    sample.ways = 8;
    sample.steps = 400;
    sample.rounding = 1e-8;
    sample.bounded = sample.kinematics->type() != "serial";
    sample.tools = sample.kinematics->type() != "scorbot";
  }
  return all;
}

inline std::vector<Sample> samples() {
  constexpr double pi = std::numbers::pi;
  constexpr double deg = pi / 180;
  const RobotArm arm;
  RobotArm vertical;
  vertical.dt = 350;
  RobotArm offset = vertical;  // every length of the arm counts
  offset.d1 = 90;
  offset.a1 = 60;
  offset.b = -40;
  offset.a3 = 70;
  OxGlide crossed;
  OxGlide extended;
  extended.form = OxGlide::Form::extended;
  OxGlide shifted;
  shifted.offset = Vec3(3, -4, -60);
  std::vector<Sample> all = {
      {"identity XYZ", make_identity({Axis::x, Axis::y, Axis::z}), axis_values(-300, -200, -400),
       axis_values(300, 200, 0)},
      {"identity XZ with offset", make_identity({Axis::x, Axis::z}, Vec3(10, 20, 30)),
       axis_values(-300, 20, -400), axis_values(300, 20, 0)},
      {"identity ZYXCBA", make_identity({Axis::z, Axis::y, Axis::x, Axis::c, Axis::b, Axis::a}),
       axis_values(-300, -200, -400, -pi, -pi, -7), axis_values(300, 200, 0, pi, pi, 7)},
      {"chain, trunnion", sample_trunnion(), axis_values(-200, -150, -300, -2, 0, -6),
       axis_values(200, 150, 100, 2, 0, 6)},
      {"chain, nutating head", sample_nutating_head(), axis_values(-200, -150, -300, 0, -3, -3),
       axis_values(200, 150, 100, 0, 3, 3)},
      {"chain, turning slide", sample_turning_slide(), axis_values(-200, -150, -300, -1, 0, -1),
       axis_values(200, 150, 100, 1, 0, 1)},
      {"ox-glide crossed", make_ox_glide(crossed), axis_values(160, -150, -357.5),
       axis_values(349, 150, -200)},
      {"ox-glide extended", make_ox_glide(extended), axis_values(150, -150, -357.5),
       axis_values(349, 150, -290)},
      {"ox-glide with offset", make_ox_glide(shifted), axis_values(163, -150, -417),
       axis_values(349, 150, -260)},
      {"robot-horizontal", make_robot_horizontal(arm),
       axis_values(-250, 400, -1400, -25 * deg, -25 * deg),
       axis_values(250, 650, -1100, 25 * deg, 25 * deg)},
      {"robot-vertical", make_robot_vertical(vertical),
       axis_values(-250, -1100, 150, -25 * deg, -25 * deg),
       axis_values(250, -850, 450, 25 * deg, 25 * deg)},
      {"robot-6r", make_robot_6r(vertical),
       axis_values(-250, -1100, 150, -25 * deg, -25 * deg, -40 * deg),
       axis_values(250, -850, 450, 25 * deg, 25 * deg, 40 * deg)},
      {"robot-6r with offsets", make_robot_6r(offset),
       axis_values(-250, -1100, 150, -25 * deg, -25 * deg, -40 * deg),
       axis_values(250, -850, 450, 25 * deg, 25 * deg, 40 * deg)},
  };
  const std::vector<Sample> more = catalogue();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// How many poses a round trip tries: `fast`, or AIRCUT_ROUND_TRIPS in the slow suite.
inline int round_trips(int fast) {
  const char* text = std::getenv("AIRCUT_ROUND_TRIPS");
  return text ? std::max(fast, std::atoi(text)) : fast;
}

inline AxisValues random_tip(const Sample& sample, Random& random) {
  AxisValues tip;
  for (const Axis axis : all_axes) tip[axis] = random.between(sample.low[axis], sample.high[axis]);
  return tip;
}

/// A tool length along Z; the target's tip stays reachable when it is moved down by the length.
inline Target with_tool(AxisValues tip, double length) {
  Target target;
  target.tool_offset[Axis::z] = length;
  tip[Axis::z] -= length;
  target.tip = tip;
  return target;
}

}  // namespace aircut::machine
