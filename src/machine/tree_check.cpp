// Does the tree draw the machine that the kinematics drives? At home and at random joints the gauge
// point of the tree, seen from M, must be where the kinematics has it (verification.md §10).
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "machine/kinematics/kinematics_table.h"
#include "machine/reading.h"

namespace aircut::machine {

namespace {

constexpr double tolerance_mm = 1e-6;
constexpr double tolerance_rad = 1e-9;

std::string text_of(const Machine& machine, const JointVector& joints) {
  std::string text;
  for (int i = 0; i < machine.joint_count(); ++i) {
    const Joint& joint = machine.joint(JointId{i});
    const double unit = joint.kind == JointKind::rotary ? 180 / std::numbers::pi : 1;
    text += (i ? " " : "") + joint.name + " " + fixed(joints[i] * unit, 3);
  }
  return text;
}

double distance(const AxisValues& a, const AxisValues& b) {
  double sum = 0;
  for (const Axis axis : all_axes) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  return std::sqrt(sum);
}

std::string text_of(const Vec3& p) {
  return "(" + fixed(p.x(), 4) + ", " + fixed(p.y(), 4) + ", " + fixed(p.z(), 4) + ")";
}

bool follows_rotary(const Machine& machine) {
  for (const KinematicsRow& row : kinematics_table())
    if (row.type == machine.kinematics().type()) return row.follows_rotary;
  return true;
}

JointVector random_joints(const Machine& machine, Random& random, bool turn, double share) {
  JointVector joints(machine.joint_count());
  const JointVector home = machine.home();
  for (int i = 0; i < machine.joint_count(); ++i) {
    const Joint& joint = machine.joint(JointId{i});
    constexpr double pi = std::numbers::pi;
    const double low = std::isfinite(joint.min) ? joint.min : -pi;
    const double high = std::isfinite(joint.max) ? joint.max : pi;
    joints[i] = joint.kind == JointKind::rotary && !turn
                    ? 0
                    : home[i] + share * (random.between(low, high) - home[i]);
  }
  return joints;
}

// Nothing when tree and kinematics agree, or when the kinematics has no position there.
std::optional<std::string> disagreement(const Machine& machine, const JointVector& joints,
                                        const AxisValues& tip, LinkPoses& poses) {
  forward(machine, joints, poses);
  const Spindle& spindle = machine.spindle();
  const Pose& X_WS = poses.X_WL[static_cast<std::size_t>(index(spindle.link))];
  const Pose& X_WK = poses.X_WL[static_cast<std::size_t>(index(machine.work_link()))];
  const Pose X_MS = (X_WK * machine.X_LM()).inverse() * X_WS;
  const Vec3 by_tree = X_MS * spindle.gauge;
  const Vec3 by_kinematics(tip[Axis::x], tip[Axis::y], tip[Axis::z]);
  if (!((by_tree - by_kinematics).norm() <= tolerance_mm))
    return "the links draw another machine than the kinematics drives: at " +
           text_of(machine, joints) + " the gauge point is at " + text_of(by_kinematics) +
           " in M by the kinematics, but at " + text_of(by_tree) + " by the links";
  const Vec3 tool_axis = X_MS.linear() * spindle.R_LF * Vec3::UnitZ();
  if (const auto wanted = machine.kinematics().tool_axis(tip);
      wanted && !((tool_axis - *wanted).norm() <= tolerance_rad))
    return "the links tilt the spindle otherwise than the kinematics: at " +
           text_of(machine, joints) + " the tool points along " + text_of(*wanted) +
           " in M by the kinematics, but along " + text_of(tool_axis) + " by the links";
  if (!machine.kinematics().axes().has(Axis::a) && !machine.kinematics().axes().has(Axis::b) &&
      !((tool_axis - Vec3::UnitZ()).norm() <= tolerance_rad))
    return "the links tilt the spindle at " + text_of(machine, joints) +
           ", but the kinematics keeps it upright";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> tree_disagrees(const Machine& machine) {
  const Kinematics& kinematics = machine.kinematics();
  LinkPoses poses;
  const auto at_home = kinematics.forward(machine.home(), {});
  if (!at_home) return "home is no position of this machine: " + at_home.error().reason;

  Random random(0x61697263);  // any fixed seed
  const bool turn = follows_rotary(machine);
  constexpr int wanted = 1000;
  int compared = 0;
  double share = 1;
  for (int tries = 1; compared < wanted && tries < 50 * wanted; ++tries) {
    // Limits that are far wider than what can be assembled: nearer to home.
    constexpr int batch = 200;
    if (tries % batch == 0 && compared < tries / 10) share /= 2;
    JointVector joints = random_joints(machine, random, turn, share);
    kinematics.couple(joints);
    const auto tip = kinematics.forward(joints, {});
    if (!tip) continue;
    ++compared;
    if (auto reason = disagreement(machine, joints, *tip, poses)) return reason;
    const auto back = kinematics.inverse({*tip, {}}, joints);
    const auto again = back ? kinematics.forward(*back, {}) : tip;
    if (!back || !again || !(distance(*again, *tip) <= tolerance_mm))
      return "the kinematics does not find its own position at " + text_of(machine, joints);
  }
  if (compared == 0) return "no joint position inside the limits can be assembled";
  return std::nullopt;
}

}  // namespace aircut::machine
