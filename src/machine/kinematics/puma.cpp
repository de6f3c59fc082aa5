// puma, three21: six-axis arms in the joint angles that are customary for them, with the pose of
// the flange itself.
//
// Joints p, arm angles θ of robot_arm.h:  θ1 = p1, θ2 = −p2 − 90°, θ3 = −p3, θ4 = p4, θ5 = 90° −
// p5, θ6 = p6. With all p zero the upper arm is level, forearm and flange point down. Pose: the
// flange's centre in {0} and R = Rz(C)·Ry(B)·Rx(A), whose z axis leads out of the flange; the
// tool's direction is −z of it, and a tool of length L moves the tip by L along z.
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/robot_arm.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

constexpr double right = std::numbers::pi / 2;

struct Puma : RobotModel {
  static constexpr int joints = 6;
  std::string_view name;

  std::string_view type() const { return name; }
  AxisSet axes() const { return axes_of("XYZABC"); }
  static constexpr std::array<RobotBranch, 4> branches() { return CoaxialRobot::branches(); }
  static RobotJoints<double> arm_angles(const JointVector& q) {
    return {q[0], -q[1] - right, -q[2], q[3], right - q[4], q[5]};
  }
  RobotBranch branch_of(const JointVector& q) const {
    const auto t = arm_angles(q);
    return branch_of_arm(p, t[1], t[2], t[4]);
  }
  std::optional<Vec3> tool_axis(const AxisValues& tip) const {
    const auto R = Rotation<double>::about_fixed(tip[Axis::a], tip[Axis::b], tip[Axis::c]);
    return -vec3(R(Vec3::UnitZ()));
  }

  template <class T>
  Wrist<T> wrist(const RobotPose<T>& tip, const Rotation<T>& R, double length) const {
    Wrist<T> w;
    w.n = R(Vec3::UnitZ());
    for (std::size_t i = 0; i < 3; ++i) w.C[i] = tip[i] - T(p.d6 + length) * w.n[i];
    return w;
  }

  /// From the arm's angles θ to the customary ones.
  template <class T>
  static RobotJoints<T> customary(RobotJoints<T> q) {
    q[1] = -q[1] - T(right);
    q[2] = -q[2];
    q[4] = T(right) - q[4];
    return q;
  }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& tip, const Vec3& tool, const RobotBranch& branch) const {
    const auto R = Rotation<T>::about_fixed(tip[3], tip[4], tip[5]);
    const Wrist<T> w = wrist(tip, R, tool.z());
    RobotJoints<T> q{};
    const Forearm<T> forearm = solve_arm(p, branch, w.C, w.n, q);
    q[5] = roll_of_flange(forearm, q, R(Vec3::UnitX()));
    return customary(q);
  }

  std::optional<std::string> solve_checked(const RobotPose<double>& tip, const Vec3& tool,
                                           const RobotBranch& branch,
                                           RobotJoints<double>& q) const {
    const auto R = Rotation<double>::about_fixed(tip[3], tip[4], tip[5]);
    const Wrist<double> w = wrist(tip, R, tool.z());
    ArmFit fit;
    if (auto error = why_no_arm(p, branch, w.C, w.n, fit)) return error;
    q = customary(joints_of(p, branch, w.C, fit, R(Vec3::UnitX())));
    return std::nullopt;
  }

  std::optional<std::string> why_not(const RobotPose<double>& tip, const Vec3& tool,
                                     const RobotBranch& branch) const {
    const auto w = wrist(tip, Rotation<double>::about_fixed(tip[3], tip[4], tip[5]), tool.z());
    ArmFit fit;
    return why_no_arm(p, branch, w.C, w.n, fit);
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const Pose X = flange(p, arm_angles(q));
    const Mat3& R = X.linear();
    const Vec3 at = X.translation() + tool.z() * R.col(2);
    AxisValues tip;
    for (int i = 0; i < 3; ++i) tip[all_axes[static_cast<std::size_t>(i)]] = at[i];
    const Vec3 angles = angles_of({{0, 1, 2}, false}, R).angles;
    for (std::size_t i = 0; i < 3; ++i) tip[all_axes[3 + i]] = angles[static_cast<int>(i)];
    return tip;
  }
};

std::shared_ptr<const Kinematics> arm_of(Parameters& p, const RobotArm& arm,
                                         std::string_view name) {
  if (arm.d4 == 0 && arm.a3 == 0) p.fail("d4", "'d4' must not be 0: the arm would have no forearm");
  if (!p.good()) return nullptr;
  Puma model;
  model.p = arm;
  model.name = name;
  return make_model(model);
}

}  // namespace

std::shared_ptr<const Kinematics> read_puma(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRRRRR");
  RobotArm arm;
  arm.a2 = p.positive("a2", 300);
  arm.a3 = p.length("a3", 50);
  arm.b = -p.length("d3", 70);
  arm.d4 = p.positive("d4", 400);
  arm.d6 = p.length("d6", 70);
  return arm_of(p, arm, "puma");
}

std::shared_ptr<const Kinematics> read_three21(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRRRRR");
  RobotArm arm;
  arm.a1 = p.length("a1", 64.2);
  arm.a2 = p.positive("a2", 305);
  arm.a3 = p.length("a3", 0);
  arm.d1 = p.length("d1", 169.77);
  arm.b = -p.length("d2", 0);
  arm.b -= p.length("d3", -6.25);
  arm.d4 = p.positive("d4", 223.63);
  arm.d6 = p.length("d6", 36.5);
  return arm_of(p, arm, "three21");
}

}  // namespace aircut::machine
