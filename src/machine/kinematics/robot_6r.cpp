// robot-6r: the six-axis arm with all joints (kinematics.md c.5, arm: robot_arm.h). The pose holds
// the roll about the tool, too: R_MT = Rx(A)·Ry(B)·Rz(C).
//
// M and the tool on the flange are those of the vertical machine: R_6T has the columns −y, −x, −z,
// so x_6 = −y_T and z_6 = −z_T. Frame 5 seen from frame 3: x_5 = (c4 s5, s4 s5, c5),
// y_5 = (−s4, c4, 0), and θ6 = atan2(y_5·x_6, x_5·x_6).
// Joints: θ1 … θ6. Pose: X Y Z A B C.
#include "machine/kinematics/robot_arm.h"

namespace aircut::machine {

namespace {

struct SixAxis {
  static constexpr std::string_view type = "robot-6r";
  static constexpr int joints = 6;
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

  // x_6 = −y_T in {0}.
  template <class T>
  RobotVector<T> x_of_flange(const RobotPose<T>& pose) const {
    using std::cos;
    using std::sin;
    const T ca = cos(pose[3]), sa = sin(pose[3]), cb = cos(pose[4]), sb = sin(pose[4]);
    const T cc = cos(pose[5]), sc = sin(pose[5]);
    return {ca * cc - sa * sb * sc, cb * sc, -(sa * cc + ca * sb * sc)};
  }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& pose, double length, const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, length);
    RobotJoints<T> q{};
    solve_arm(p, branch, C, n, q);
    using std::atan2;
    using std::cos;
    using std::sin;
    const RobotVector<T> x6 = Forearm<T>(q[0], q[1] + q[2]).seen(x_of_flange(pose));
    const T c4 = cos(q[3]), s4 = sin(q[3]), c5 = cos(q[4]), s5 = sin(q[4]);
    q[5] = atan2(c4 * x6[1] - s4 * x6[0], s5 * (c4 * x6[0] + s4 * x6[1]) + c5 * x6[2]);
    return q;
  }

  std::optional<std::string> why_not(const RobotPose<double>& pose, double length,
                                     const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, length);
    return why_no_arm(p, branch, {C[0], C[1], C[2]}, {n[0], n[1], n[2]});
  }

  Pose gauge(const JointVector& q) const {
    return tool_on_flange(p, {q[0], q[1], q[2], q[3], q[4], q[5]});
  }
};

}  // namespace

std::shared_ptr<const Kinematics> make_robot_6r(const RobotArm& arm) {
  return std::make_shared<RobotKinematics<SixAxis>>(arm);
}

std::shared_ptr<const Kinematics> read_robot_6r(KinematicsInput& input) {
  RobotArm arm{.dt = 350};
  if (!read_robot_arm(input, SixAxis::type, SixAxis::joints, coaxial_robot_keys(), arm))
    return nullptr;
  return make_robot_6r(arm);
}

}  // namespace aircut::machine
