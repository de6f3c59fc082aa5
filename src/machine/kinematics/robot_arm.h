// The arm of the vertical and of the six-axis robot: six rotary joints whose last three axes meet
// in the wrist centre C (kinematics.md c.1, c.5). {0}: z up along joint 1, x forward at θ1 = 0.
//
//            a2          ψ = θ2 + θ3, in the vertical plane of e_r (outwards) and e_z:
//   elbow  o-----        upper arm    a2·(−sin θ2, cos θ2)
//         /  d4  \ C     elbow offset a3·x3, x3 = (−sin ψ, cos ψ)
//        /        o      forearm      d4·z3, z3 = (cos ψ, sin ψ)
//    d1 o          \ d6  the plane is b off the axis of joint 1, along z1 = (sin θ1, −cos θ1, 0)
//       |           v flange
//
// With r² = Cx² + Cy² − b², u = ±r − a1, v = Cz − d1, L3 = √(a3² + d4²), φ = atan2(d4, a3):
//
//   K = (u² + v² − a2² − L3²) / (2 a2 L3),   θ3 = φ − e·acos K
//   θ2 = atan2(v, u) − 90° − atan2(−e·L3·√(1 − K²), a2 + L3·K)
//
// n, the direction of the flange, seen from frame 3 is (−c5 c4, −c5 s4, s5); that gives θ4 and θ5.
#pragma once

#include "machine/kinematics/robot.h"

namespace aircut::machine {

/// Frame 3, whose x axis leads from the elbow across the forearm and z along it.
template <class T>
struct Forearm {
  T c1, s1, c23, s23;
  /// A direction of {0} seen from frame 3.
  Vector<T> seen(const Vector<T>& a) const {
    const T out = c1 * a[0] + s1 * a[1];  // along e_r
    return {c23 * a[2] - s23 * out, s1 * a[0] - c1 * a[1], c23 * out + s23 * a[2]};
  }
};
template <class T>
Forearm<T> forearm_at(const T& t1, const T& t23) {
  using std::cos;
  using std::sin;
  return {cos(t1), sin(t1), cos(t23), sin(t23)};
}

/// The triangle of shoulder, elbow and wrist centre: r, u, v and K of above.
template <class T>
struct ArmTriangle {
  T r, u, v, K;
};
template <class T>
ArmTriangle<T> arm_triangle(const RobotArm& p, const RobotBranch& branch, const Vector<T>& C) {
  using std::sqrt;
  ArmTriangle<T> t;
  t.r = T(branch.shoulder) * sqrt(square(C[0]) + square(C[1]) - T(p.b * p.b));
  t.u = t.r - T(p.a1);
  t.v = C[2] - T(p.d1);
  const double l3 = std::sqrt(p.a3 * p.a3 + p.d4 * p.d4);
  t.K = (square(t.u) + square(t.v) - T(p.a2 * p.a2 + l3 * l3)) * T(1 / (2 * p.a2 * l3));
  return t;
}

/// θ1, θ2, θ3 for the wrist centre C in {0}.
template <class T>
void arm_angles(const RobotArm& p, const RobotBranch& branch, const Vector<T>& C,
                const ArmTriangle<T>& t, RobotJoints<T>& q) {
  using std::acos;
  using std::atan2;
  using std::sqrt;
  const T f(branch.shoulder), e(branch.elbow);
  if (p.b == 0)
    q[0] = atan2(f * C[1], f * C[0]);
  else
    q[0] = atan2(C[1] * t.r + C[0] * T(p.b), C[0] * t.r - C[1] * T(p.b));
  const double l3 = std::sqrt(p.a3 * p.a3 + p.d4 * p.d4);
  q[2] = T(std::atan2(p.d4, p.a3)) - e * acos(t.K);
  const T lift = e * T(l3) * sqrt((T(1) - t.K) * (T(1) + t.K));
  q[1] = atan2(t.v, t.u) - T(std::numbers::pi / 2) + atan2(lift, T(p.a2) + T(l3) * t.K);
}

/// θ4 and θ5 for the flange's direction m seen from frame 3; `out` = √(m0² + m1²).
template <class T>
void wrist_angles(const RobotBranch& branch, const Vector<T>& m, const T& out, RobotJoints<T>& q) {
  using std::atan2;
  const T w(branch.wrist);
  q[3] = atan2(-w * m[1], -w * m[0]);
  q[4] = atan2(m[2], w * out);
}

/// θ1 … θ5 for the wrist centre C and the direction n of the flange, both in {0}; frame 3 there.
template <class T>
Forearm<T> solve_arm(const RobotArm& p, const RobotBranch& branch, const Vector<T>& C,
                     const Vector<T>& n, RobotJoints<T>& q) {
  using std::sqrt;
  arm_angles(p, branch, C, arm_triangle(p, branch, C), q);
  const Forearm<T> forearm = forearm_at(q[0], q[1] + q[2]);
  const Vector<T> m = forearm.seen(n);
  wrist_angles(branch, m, sqrt(square(m[0]) + square(m[1])), q);
  return forearm;
}

/// θ6 for the flange's x axis seen from frame 3. Frame 5 there: x_5 = (c4 s5, s4 s5, c5), y_5 =
/// (−s4, c4, 0), and θ6 = atan2(y_5·x_6, x_5·x_6).
template <class T>
T roll_of(const T& c4, const T& s4, const T& c5, const T& s5, const Vector<T>& x6) {
  using std::atan2;
  return atan2(c4 * x6[1] - s4 * x6[0], s5 * (c4 * x6[0] + s4 * x6[1]) + c5 * x6[2]);
}
template <class T>
T roll_of_flange(const Forearm<T>& forearm, const RobotJoints<T>& q, const Vector<T>& x6_in_0) {
  using std::cos;
  using std::sin;
  return roll_of<T>(cos(q[3]), sin(q[3]), cos(q[4]), sin(q[4]), forearm.seen(x6_in_0));
}

/// The arm in a pose, without any angle: each is the angle of a vector, so that its cosine and sine
/// are quotients.
struct ArmFit {
  ArmTriangle<double> triangle;
  Forearm<double> forearm;
  Vector<double> m;  ///< direction of the flange seen from frame 3
  double out = 0;    ///< √(m0² + m1²) = |cos θ5|
};
/// Why there is no solution; nothing, and the fit, when there is one.
std::optional<std::string> why_no_arm(const RobotArm& p, const RobotBranch& branch,
                                      const Vector<double>& C, const Vector<double>& n,
                                      ArmFit& fit);
/// θ1 … θ6 of a fit, for the flange's x axis in {0}.
RobotJoints<double> joints_of(const RobotArm& p, const RobotBranch& branch, const Vector<double>& C,
                              const ArmFit& fit, const Vector<double>& x6_in_0);
/// Of joints θ1 … θ5.
RobotBranch branch_of_arm(const RobotArm& p, double t2, double t3, double t5);
/// The flange (frame 6) seen from {0}.
Pose flange(const RobotArm& p, const RobotJoints<double>& q);
/// The tip of a tool on the flange's axis, dt beyond it, seen from M (x_M = y_0, y_M = −x_0).
Pose tool_on_flange(const RobotArm& p, const RobotJoints<double>& q);
/// The wrist of a machine with the tool on the flange's axis. M: v_0 = (−v_My, v_Mx, v_Mz).
template <class T>
struct Wrist {
  Vector<T> C, n;  ///< its centre and the direction of the flange, in {0}
};
struct CoaxialRobot : RobotModel {
  // The four configurations of shoulder and elbow; the wrist's side changes no slope's size.
  static constexpr std::array<RobotBranch, 4> branches() {
    return {{{1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}}};
  }
  RobotBranch branch_of(const JointVector& q) const { return branch_of_arm(p, q[1], q[2], q[4]); }

  // The tool points from the flange along z_6, so k = −z_6 and C = tip + (d6 + dt + L)·k.
  template <class T>
  Wrist<T> wrist(const RobotPose<T>& pose, double length) const {
    using std::cos;
    using std::sin;
    const T reach(p.d6 + p.dt + length);
    const T ca = cos(pose[3]), sa = sin(pose[3]), cb = cos(pose[4]), sb = sin(pose[4]);
    const Vector<T> k = {sa * cb, sb, ca * cb};
    return {{reach * k[0] - pose[1], reach * k[1] + pose[0], reach * k[2] + pose[2]},
            {-k[0], -k[1], -k[2]}};
  }

  std::optional<std::string> why_not(const RobotPose<double>& pose, const Vec3& tool,
                                     const RobotBranch& branch) const {
    const auto [C, n] = wrist(pose, tool.z());
    ArmFit fit;
    return why_no_arm(p, branch, C, n, fit);
  }
};

/// The keys that the machines with a tool on the flange's axis have.
std::span<const RobotKey> coaxial_robot_keys();

}  // namespace aircut::machine
