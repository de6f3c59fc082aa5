#include "machine/kinematics/robot_arm.h"

namespace aircut::machine {

std::optional<std::string> why_no_arm(const RobotArm& p, const RobotBranch& branch, const Vec3& C,
                                      const Vec3& n) {
  const double out = std::hypot(C.x(), C.y());
  const double r2 = (out - p.b) * (out + p.b);
  if (!(r2 > robot_singular * robot_singular) || !(out > robot_singular))
    return "the centre of the wrist is " + fixed(out, 3) + " mm from the axis of joint 1" +
           (p.b == 0 ? ", where joint 1 can turn freely (a singular pose)"
                     : "; it must stay farther than " + fixed(std::abs(p.b), 3) + " mm");
  const double u = branch.shoulder * std::sqrt(r2) - p.a1, v = C.z() - p.d1;
  const double l3 = std::hypot(p.a3, p.d4), far = std::hypot(u, v);
  if (far > p.a2 + l3)
    return "the centre of the wrist is " + fixed(far - p.a2 - l3, 3) +
           " mm beyond the reach of the arm, " + fixed(p.a2 + l3, 3) + " mm";
  if (far < std::abs(p.a2 - l3))
    return "the centre of the wrist is " + fixed(std::abs(p.a2 - l3) - far, 3) +
           " mm nearer to the shoulder than the folded arm gets";
  const double K = (far * far - p.a2 * p.a2 - l3 * l3) / (2 * p.a2 * l3);
  if (!((1 - K) * (1 + K) > robot_singular * robot_singular))
    return "the arm is " + std::string(K > 0 ? "stretched" : "folded") +
           ": joint 3 would need an infinite speed there (a singular pose)";
  RobotJoints<double> q{};
  solve_arm<double>(p, branch, {C.x(), C.y(), C.z()}, {n.x(), n.y(), n.z()}, q);
  if (!(std::abs(std::cos(q[4])) > robot_singular))
    return "the flange is in line with the forearm, where joint 4 can turn freely (a singular "
           "pose)";
  return std::nullopt;
}

RobotBranch branch_of_arm(const RobotArm& p, double t2, double t3, double t5) {
  const double t23 = t2 + t3;
  const double r = p.a1 - p.a2 * std::sin(t2) - p.a3 * std::sin(t23) + p.d4 * std::cos(t23);
  const double bend = std::sin(std::atan2(p.d4, p.a3) - t3);
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
