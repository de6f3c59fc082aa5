// robot-horizontal: a six-axis arm as a five-axis machine with a horizontal spindle; joint 4 is
// blocked at zero (kinematics.md c.3). Joints: θ1 θ2 θ3, θ4 and θ5 of the wrist (5 and 6 of the
// arm).
//
//   seen from the side, θ1 = 0:      M: x_M = −y_0, y_M = z_0 (up), z_M = −x_0 (towards the robot)
//
//     elbow o------d4------o wrist          The spindle lies across the flange's axis, in the
//        a2/               | D = d6 + dt    interface I, and its tip is at p = I − (at + L)·k.
//         o shoulder    ---I-->             D points along (sin θ234, −cos θ234) in the plane of
//                     tip  at   k           the arm, θ234 = θ2 + θ3 + θ4.
//
// With pI = p + at·k, rI its distance from the axis of joint 1, and sums of angles written
// together:
//   θ1 = atan2(−pIx, −pIz)      s5 = −c1 kx + s1 kz, c5 > 0      θ234 = atan2(−ky, s1 kx + c1 kz)
//   v1 = rI − D s234, v2 = pIy + D c234 (wrist)    s3 = (v1² + v2² − a2² − d4²) / (2 a2 d4), c3 > 0
//   θ2 = atan2(d4 c3, a2 + d4 s3) − atan2(v1, v2)      θ4 = θ234 − θ2 − θ3
// det ∂(p, k)/∂θ = ±a2 d4 c3 rI c5: its factors are the singular poses.
#include "machine/kinematics/robot.h"

namespace aircut::machine {

namespace {

struct Horizontal : RobotModel {
  static constexpr int joints = 5;
  std::string_view type() const { return "robot-horizontal"; }
  AxisSet axes() const { return axes_of("XYZAB"); }

  // Shoulder in front, elbow and spindle on one side: the only configuration.
  static constexpr std::array<RobotBranch, 1> branches() { return {{{1, 1, 1}}}; }
  RobotBranch branch_of(const JointVector&) const { return {}; }

  /// What the solution goes through, and what decides whether there is one.
  template <class T>
  struct Way {
    T x, y, z;        // interface I in M
    T kx, ky, kz;     // tool direction in M
    T t1, c1, s1, r;  // r = rI
    T s5;
    T t234, v1, v2;
    T s3;
  };

  template <class T>
  Way<T> way(const RobotPose<T>& pose, double length) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T at(p.at + length), D(p.d6 + p.dt);
    Way<T> w;
    const T cb = cos(pose[4]);
    w.kx = sin(pose[4]);
    w.ky = -sin(pose[3]) * cb;
    w.kz = cos(pose[3]) * cb;
    w.x = pose[0] + at * w.kx;
    w.y = pose[1] + at * w.ky;
    w.z = pose[2] + at * w.kz;
    w.r = sqrt(square(w.x) + square(w.z));
    w.t1 = atan2(-w.x, -w.z);
    w.c1 = cos(w.t1);
    w.s1 = sin(w.t1);
    w.s5 = w.s1 * w.kz - w.c1 * w.kx;
    w.t234 = atan2(-w.ky, w.s1 * w.kx + w.c1 * w.kz);
    w.v1 = w.r - D * sin(w.t234);
    w.v2 = w.y + D * cos(w.t234);
    w.s3 = (square(w.v1) + square(w.v2) - T(p.a2 * p.a2 + p.d4 * p.d4)) * T(1 / (2 * p.a2 * p.d4));
    return w;
  }

  template <class T>
  RobotJoints<T> solve(const RobotPose<T>& pose, const Vec3& tool, const RobotBranch&) const {
    using std::acos;
    using std::atan2;
    using std::sqrt;
    const Way<T> w = way(pose, tool.z());
    RobotJoints<T> q{};
    q[0] = w.t1;
    q[4] = T(std::numbers::pi / 2) - acos(w.s5);
    q[2] = T(std::numbers::pi / 2) - acos(w.s3);
    const T c3 = sqrt((T(1) - w.s3) * (T(1) + w.s3));
    q[1] = atan2(T(p.d4) * c3, T(p.a2) + T(p.d4) * w.s3) - atan2(w.v1, w.v2);
    q[3] = w.t234 - q[1] - q[2];
    return q;
  }

  std::optional<std::string> why_not(const RobotPose<double>& pose, const Vec3& tool,
                                     const RobotBranch&) const {
    const Way<double> w = way(pose, tool.z());
    if (!(w.r > robot_singular))
      return "the spindle's interface is on the axis of joint 1, which can turn freely there (a "
             "singular pose)";
    if (!((1 - w.s5) * (1 + w.s5) > robot_singular * robot_singular))
      return "the tool is parallel to the axes of joints 2 to 4, which can turn freely there (a "
             "singular pose)";
    const double far = std::hypot(w.v1, w.v2);
    if (far > p.a2 + p.d4)
      return "the wrist is " + fixed(far - p.a2 - p.d4, 3) + " mm beyond the reach of the arm, " +
             fixed(p.a2 + p.d4, 3) + " mm";
    if (far < std::abs(p.a2 - p.d4))
      return "the wrist is " + fixed(std::abs(p.a2 - p.d4) - far, 3) +
             " mm nearer to the shoulder than the folded arm gets";
    if (!((1 - w.s3) * (1 + w.s3) > robot_singular * robot_singular))
      return "the arm is " + std::string(w.s3 > 0 ? "stretched" : "folded") +
             ": joint 3 would need an infinite speed there (a singular pose)";
    return std::nullopt;
  }

  // Joints of another configuration are no position of this machine.
  std::optional<std::string> why_not_joints(const JointVector& q) const {
    const double r = (p.d6 + p.dt) * std::sin(q[1] + q[2] + q[3]) + p.d4 * std::cos(q[1] + q[2]) -
                     p.a2 * std::sin(q[1]);
    if (!(r > 0))
      return "the spindle's interface is " + fixed(-r, 3) +
             " mm behind the axis of joint 1; the machine works in front of it";
    if (!(std::cos(q[2]) > 0))
      return "joint 3 is beyond 90 degrees: the elbow is on the other side";
    if (!(std::cos(q[4]) > 0)) return "joint 5 is beyond 90 degrees: the spindle points backwards";
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    if (auto error = why_not_joints(q)) return unexpected(ReachError{std::move(*error)});
    return robot_tip(gauge(q), tool, false);
  }

  // Gauge point and axes of the tool in M, from the chain of joints.
  Pose gauge(const JointVector& q) const {
    const auto about = [](double angle, const Vec3& axis) {
      return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    };
    // In {0}: joints 2 to 4 turn about −y, joint 5 about the flange's axis (−z at zero).
    const Mat3 R1 = about(q[0], Vec3::UnitZ());
    const Mat3 R2 = R1 * about(q[1], -Vec3::UnitY());
    const Mat3 R3 = R2 * about(q[2], -Vec3::UnitY());
    const Mat3 R4 = R3 * about(q[3], -Vec3::UnitY());
    const Mat3 R5 = R4 * about(q[4], -Vec3::UnitZ());
    const Vec3 interface =
        R2 * Vec3(0, 0, p.a2) + R3 * Vec3(p.d4, 0, 0) + R4 * Vec3(0, 0, -(p.d6 + p.dt));
    Mat3 R_M0;
    R_M0 << 0, -1, 0, 0, 0, 1, -1, 0, 0;
    Pose X = Pose::Identity();
    X.linear() = R_M0 * R5 * R_M0.transpose();  // T is parallel to M at zero
    X.translation() = R_M0 * interface - p.at * X.linear().col(2);
    return X;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> make_robot_horizontal(const RobotArm& arm) {
  return make_model(Horizontal{RobotModel{{}, arm}});
}

std::shared_ptr<const Kinematics> read_robot_horizontal(KinematicsInput& input) {
  static constexpr std::array<RobotKey, 5> keys = {{{"a2", &RobotArm::a2, true},
                                                    {"d4", &RobotArm::d4, true},
                                                    {"d6", &RobotArm::d6, false},
                                                    {"dt", &RobotArm::dt, false},
                                                    {"at", &RobotArm::at, false}}};
  RobotArm arm;
  if (!read_robot_arm(input, "robot-horizontal", Horizontal::joints, keys, arm)) return nullptr;
  return make_robot_horizontal(arm);
}

}  // namespace aircut::machine
