#include "machine/kinematics/robot_arm.h"

namespace aircut::machine {

namespace {

// θ2 + 90° = atan2(v, u) + atan2(lift, a2 + l3 K), where both vectors have the length far =
// √(u² + v²); θ3 = φ − e·acos K; θ1 is the angle of (C_x r − C_y b, C_y r + C_x b), whose length is
// C_x² + C_y².
Forearm<double> forearm_of(const RobotArm& p, const RobotBranch& branch, const Vector<double>& C,
                           const ArmTriangle<double>& t) {
  const double along1 = 1 / (C[0] * C[0] + C[1] * C[1]);
  const double l3 = std::sqrt(p.a3 * p.a3 + p.d4 * p.d4);
  const double bend = branch.elbow * std::sqrt((1 - t.K) * (1 + t.K));
  const double along = p.a2 + l3 * t.K, lift = l3 * bend;
  // θ23 = (θ2 + 90°) + θ3 − 90°, with cosines and sines of the first two in lengths.
  const double c2 = t.u * along - t.v * lift, s2 = t.v * along + t.u * lift;
  const double c3 = p.a3 * t.K + p.d4 * bend, s3 = p.d4 * t.K - p.a3 * bend;
  const double along23 = 1 / ((t.u * t.u + t.v * t.v) * l3);
  return {(C[0] * t.r - C[1] * p.b) * along1, (C[1] * t.r + C[0] * p.b) * along1,
          (s2 * c3 + c2 * s3) * along23, (s2 * s3 - c2 * c3) * along23};
}

}  // namespace

std::optional<std::string> why_no_arm(const RobotArm& p, const RobotBranch& branch,
                                      const Vector<double>& C, const Vector<double>& n,
                                      ArmFit& fit) {
  // Lengths of an arm are far from where a square could overflow.
  const double out2 = C[0] * C[0] + C[1] * C[1];
  if (!(out2 - p.b * p.b > robot_singular * robot_singular) ||
      !(out2 > robot_singular * robot_singular)) {
    const double out = std::sqrt(out2);
    return "the centre of the wrist is " + fixed(out, 3) + " mm from the axis of joint 1" +
           (p.b == 0 ? ", where joint 1 can turn freely (a singular pose)"
                     : "; it must stay farther than " + fixed(std::abs(p.b), 3) + " mm");
  }
  fit.triangle = arm_triangle(p, branch, C);
  const double K = fit.triangle.K;
  if (!((1 - K) * (1 + K) > robot_singular * robot_singular)) {
    const double u = fit.triangle.u, v = fit.triangle.v;
    const double l3 = std::sqrt(p.a3 * p.a3 + p.d4 * p.d4), far = std::sqrt(u * u + v * v);
    if (far > p.a2 + l3)
      return "the centre of the wrist is " + fixed(far - p.a2 - l3, 3) +
             " mm beyond the reach of the arm, " + fixed(p.a2 + l3, 3) + " mm";
    if (far < std::abs(p.a2 - l3))
      return "the centre of the wrist is " + fixed(std::abs(p.a2 - l3) - far, 3) +
             " mm nearer to the shoulder than the folded arm gets";
    return "the arm is " + std::string(K > 0 ? "stretched" : "folded") +
           ": joint 3 would need an infinite speed there (a singular pose)";
  }
  fit.forearm = forearm_of(p, branch, C, fit.triangle);
  fit.m = fit.forearm.seen(n);
  fit.out = std::sqrt(fit.m[0] * fit.m[0] + fit.m[1] * fit.m[1]);
  if (!(fit.out > robot_singular))
    return "the flange is in line with the forearm, where joint 4 can turn freely (a singular "
           "pose)";
  return std::nullopt;
}

RobotJoints<double> joints_of(const RobotArm& p, const RobotBranch& branch, const Vector<double>& C,
                              const ArmFit& fit, const Vector<double>& x6_in_0) {
  RobotJoints<double> q{};
  arm_angles(p, branch, C, fit.triangle, q);
  wrist_angles(branch, fit.m, fit.out, q);
  const double w = branch.wrist, across = -w / fit.out;
  q[5] = roll_of(across * fit.m[0], across * fit.m[1], w * fit.out, fit.m[2],
                 fit.forearm.seen(x6_in_0));
  return q;
}

RobotBranch branch_of_arm(const RobotArm& p, double t2, double t3, double t5) {
  const double c2 = std::cos(t2), s2 = std::sin(t2), c3 = std::cos(t3), s3 = std::sin(t3);
  const double r = p.a1 - p.a2 * s2 - p.a3 * (s2 * c3 + c2 * s3) + p.d4 * (c2 * c3 - s2 * s3);
  const double bend = p.d4 * c3 - p.a3 * s3;  // sin(atan2(d4, a3) − θ3), but for its size
  const auto side = [](double x) { return x >= 0 ? 1.0 : -1.0; };
  return {side(r), side(bend), side(std::cos(t5))};
}

Pose flange(const RobotArm& p, const RobotJoints<double>& q) {
  constexpr double right = std::numbers::pi / 2;
  // Standard Denavit-Hartenberg rows Rz(θ) Tz(d) Tx(a) Rx(α).
  const auto row = [](double theta, double d, double a, double alpha) {
    Pose X = Pose::Identity();
    X.linear() = (Eigen::AngleAxisd(theta, Vec3::UnitZ()) * Eigen::AngleAxisd(alpha, Vec3::UnitX()))
                     .toRotationMatrix();
    X.translation() = Vec3(a * std::cos(theta), a * std::sin(theta), d);
    return X;
  };
  return row(q[0], p.d1, p.a1, right) * row(q[1] + right, p.b, p.a2, 0) *
         row(q[2], 0, p.a3, right) * row(q[3], p.d4, 0, -right) * row(q[4] - right, 0, 0, right) *
         row(q[5], p.d6, 0, 0);
}

Pose tool_on_flange(const RobotArm& p, const RobotJoints<double>& q) {
  Pose X_M0 = Pose::Identity();
  X_M0.linear() << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  Pose X_6T = translation(Vec3(0, 0, p.dt));
  X_6T.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  return X_M0 * flange(p, q) * X_6T;
}

std::span<const RobotKey> coaxial_robot_keys() {
  static constexpr std::array<RobotKey, 8> keys = {{{"d1", &RobotArm::d1, false},
                                                    {"a1", &RobotArm::a1, false},
                                                    {"b", &RobotArm::b, false},
                                                    {"a2", &RobotArm::a2, true},
                                                    {"a3", &RobotArm::a3, false},
                                                    {"d4", &RobotArm::d4, true},
                                                    {"d6", &RobotArm::d6, false},
                                                    {"dt", &RobotArm::dt, false}}};
  return keys;
}

bool read_robot_arm(KinematicsInput& input, std::string_view type, int joints,
                    std::span<const RobotKey> keys, RobotArm& arm) {
  bool good = true;
  for (const RobotKey& k : keys) {
    double& value = arm.*k.length;
    if (input.table.has(k.key)) value = length(input.table, k.key, value, input.unit_mm);
    if (!k.positive || value > 0) continue;
    input.table.error(k.key, "'" + std::string(k.key) + "' must be more than 0, this is " +
                                 shortest(value / input.unit_mm));
    good = false;
  }
  bool rotary = true;
  for (const Joint& joint : input.driven) rotary = rotary && joint.kind == JointKind::rotary;
  if (rotary && input.driven.size() == static_cast<std::size_t>(joints)) return good;
  input.table.error("type", "'" + std::string(type) + "' needs " + std::to_string(joints) +
                                " driven axes, all rotary, in the order of the joints");
  return false;
}

}  // namespace aircut::machine
