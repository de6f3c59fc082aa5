// robot-6r: the six-axis arm with all joints (kinematics.md c.5, arm: robot_arm.h). The pose holds
// the roll about the tool, too: R_MT = Rx(A)·Ry(B)·Rz(C).
//
// M and the tool on the flange are those of the vertical machine: R_6T has the columns −y, −x, −z,
// so x_6 = −y_T and z_6 = −z_T.
// Joints: θ1 … θ6. Pose: X Y Z A B C.
#include "machine/kinematics/robot_arm.h"

namespace aircut::machine {

namespace {

struct SixAxis : CoaxialRobot {
  static constexpr int joints = 6;
  std::string_view type() const { return "robot-6r"; }
  AxisSet axes() const { return axes_of("XYZABC"); }

  // x_6 = −y_T in {0}.
  template <class T>
  Vector<T> x_of_flange(const RobotPose<T>& pose) const {
    using std::cos;
    using std::sin;
    const T ca = cos(pose[3]), sa = sin(pose[3]), cb = cos(pose[4]), sb = sin(pose[4]);
    const T cc = cos(pose[5]), sc = sin(pose[5]);
    return {ca * cc - sa * sb * sc, cb * sc, -(sa * cc + ca * sb * sc)};
  }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& pose, const Vec3& tool,
                       const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, tool.z());
    RobotJoints<T> q{};
    const Forearm<T> forearm = solve_arm(p, branch, C, n, q);
    q[5] = roll_of_flange(forearm, q, x_of_flange(pose));
    return q;
  }

  std::optional<std::string> solve_checked(const RobotPose<double>& pose, const Vec3& tool,
                                           const RobotBranch& branch,
                                           RobotJoints<double>& q) const {
    const auto [C, n] = wrist(pose, tool.z());
    ArmFit fit;
    if (auto error = why_no_arm(p, branch, C, n, fit)) return error;
    q = joints_of(p, branch, C, fit, x_of_flange(pose));
    return std::nullopt;
  }

  // Every position of the joints has a pose, and a branch that finds it again.
  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    return robot_tip(tool_on_flange(p, {q[0], q[1], q[2], q[3], q[4], q[5]}), tool, true);
  }
};

}  // namespace

std::shared_ptr<const Kinematics> make_robot_6r(const RobotArm& arm) {
  return make_model(SixAxis{CoaxialRobot{RobotModel{{}, arm}}});
}

std::shared_ptr<const Kinematics> read_robot_6r(KinematicsInput& input) {
  RobotArm arm{.dt = 350};
  if (!read_robot_arm(input, "robot-6r", SixAxis::joints, coaxial_robot_keys(), arm))
    return nullptr;
  return make_robot_6r(arm);
}

}  // namespace aircut::machine
