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

struct Vertical : CoaxialRobot {
  static constexpr int joints = 5;
  std::string_view type() const { return "robot-vertical"; }
  AxisSet axes() const { return axes_of("XYZAB"); }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& pose, const Vec3& tool,
                       const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, tool.z());
    RobotJoints<T> q{};
    solve_arm(p, branch, C, n, q);
    return q;
  }

  // Every position of the joints has a pose, and a branch that finds it again.
  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    return robot_tip(tool_on_flange(p, {q[0], q[1], q[2], q[3], q[4], 0}), tool, false);
  }
};

}  // namespace

std::shared_ptr<const Kinematics> make_robot_vertical(const RobotArm& arm) {
  return make_model(Vertical{CoaxialRobot{RobotModel{{}, arm}}});
}

std::shared_ptr<const Kinematics> read_robot_vertical(KinematicsInput& input) {
  RobotArm arm{.dt = 350};
  if (!read_robot_arm(input, "robot-vertical", Vertical::joints, coaxial_robot_keys(), arm))
    return nullptr;
  return make_robot_vertical(arm);
}

}  // namespace aircut::machine
