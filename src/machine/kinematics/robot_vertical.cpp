// robot-vertical: a six-axis arm as a five-axis machine with a vertical spindle; joint 6 is blocked
// at zero, because the spindle stands on the flange's axis and turning it changes nothing
// (kinematics.md c.4, arm: robot_arm.h).
//
// M: x_M = y_0, y_M = −x_0, z_M = z_0. The tool points from the flange along z_6, so k = −z_6, and
// with the tip at dt + L beyond the flange the wrist centre is C = p + (d6 + dt + L)·k.
// Joints: θ1 … θ5. Pose: X Y Z A B.
#include "machine/kinematics/robot_arm.h"

namespace aircut::machine {

namespace {

struct Vertical {
  static constexpr std::string_view type = "robot-vertical";
  static constexpr int joints = 5;
  RobotArm p;

  // The four configurations of shoulder and elbow; the wrist's side changes no slope's size.
  static constexpr std::array<RobotBranch, 4> branches() {
    return {{{1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}}};
  }
  RobotBranch branch_of(const JointVector& q) const { return branch_of_arm(p, q[1], q[2], q[4]); }

  // Every position of the joints has a pose, and a branch that finds it again.
  std::optional<std::string> why_not_joints(const JointVector&) const { return std::nullopt; }

  // Wrist centre and direction of the flange in {0}: v_0 = (−v_My, v_Mx, v_Mz).
  template <class T>
  std::pair<RobotVector<T>, RobotVector<T>> wrist(const RobotPose<T>& pose, double length) const {
    using std::cos;
    using std::sin;
    const T reach(p.d6 + p.dt + length);
    const T ca = cos(pose[3]), sa = sin(pose[3]), cb = cos(pose[4]), sb = sin(pose[4]);
    const RobotVector<T> k = {sa * cb, sb, ca * cb};
    return {{reach * k[0] - pose[1], reach * k[1] + pose[0], reach * k[2] + pose[2]},
            {-k[0], -k[1], -k[2]}};
  }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& pose, double length, const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, length);
    RobotJoints<T> q{};
    solve_arm(p, branch, C, n, q);
    return q;
  }

  std::optional<std::string> why_not(const RobotPose<double>& pose, double length,
                                     const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, length);
    return why_no_arm(p, branch, {C[0], C[1], C[2]}, {n[0], n[1], n[2]});
  }

  Pose gauge(const JointVector& q) const {
    return tool_on_flange(p, {q[0], q[1], q[2], q[3], q[4], 0});
  }
};

}  // namespace

std::shared_ptr<const Kinematics> make_robot_vertical(const RobotArm& arm) {
  return std::make_shared<RobotKinematics<Vertical>>(arm);
}

std::shared_ptr<const Kinematics> read_robot_vertical(KinematicsInput& input) {
  RobotArm arm{.dt = 350};
  if (!read_robot_arm(input, Vertical::type, Vertical::joints, coaxial_robot_keys(), arm))
    return nullptr;
  return make_robot_vertical(arm);
}

}  // namespace aircut::machine
