// One machine or more of every kinematics type, with a box of poses that it reaches. The contract
// tests loop over them; a row of the kinematics table without a sample fails.
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "machine/kinematics/chain.h"
#include "machine/machine.h"
#include "machine/random.h"

namespace aircut::machine {

struct Sample {
  std::string name;
  std::shared_ptr<const Kinematics> kinematics;
  AxisValues low, high;  ///< tip poses, all reachable; mm and rad
};

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
  return {
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
