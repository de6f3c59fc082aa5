// scorbot: a turning base and two links in an upright plane; the wrist's pitch A and roll B are
// joints of their own, or driven by a differential.
//
//   r = base_out + l1 cos s + l2 cos e,   z = base_up + l1 sin s + l2 sin e
//
// s, e: shoulder and elbow, both measured from the level. With (u, v) = (r − base_out, z −
// base_up), d their length and α = acos((d² + l1² − l2²) / (2 d l1)): s = atan2(v, u) ± α, + with
// the elbow above. X Y Z are those of the wrist, so a tool's length is not followed and offsets are
// refused. Joints: base, shoulder, elbow, then A and B, or with differential A + B and A − B.
// Passive, when the tree has them: platform_x, _y, _z, the wrist's place (shoulder and elbow are
// measured from the level, which no tree of hinges draws).
#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

struct Scorbot : BasicModel {
  static constexpr int joints = 5, passives = 3;
  double out = 16, up = 140, l1 = 221, l2 = 221;
  bool differential = false;
  bool follows = false;  ///< the tree has couples for the wrist's place

  std::string_view type() const { return "scorbot"; }
  AxisSet axes() const { return axes_of("XYZAB"); }
  std::vector<std::string> passive_names() const {
    if (!follows) return {};
    return {"platform_x", "platform_y", "platform_z"};
  }
  int passive_count() const { return follows ? passives : 0; }
  bool rotary(int joint) const { return joint < 3; }  // the wrist's turns count
  static constexpr std::array<int, 2> branches() { return {1, -1}; }
  int branch_of(const JointVector& q) const { return std::sin(q[1] - q[2]) >= 0 ? 1 : -1; }
  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    return wrong_offset_beyond(offset, 0, "X Y Z are those of the wrist");
  }

  template <class T>
  std::array<T, joints + passives> solve(const PoseWords<T>& tip, const Vec3&, int side) const {
    using std::acos;
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T u = sqrt(square(tip[0]) + square(tip[1])) - T(out), v = tip[2] - T(up);
    const T d = sqrt(square(u) + square(v));
    std::array<T, joints + passives> q{};
    q[0] = atan2(tip[1], tip[0]);
    q[1] = atan2(v, u) + T(side) * acos((d + T(l1 * l1 - l2 * l2) / d) * T(1 / (2 * l1)));
    q[2] = atan2(v - T(l1) * sin(q[1]), u - T(l1) * cos(q[1]));
    q[3] = differential ? tip[3] + tip[4] : tip[3];
    q[4] = differential ? tip[3] - tip[4] : tip[4];
    for (std::size_t i = 0; i < passives; ++i) q[joints + i] = tip[i];
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3&, int) const {
    const double r = std::hypot(tip[0], tip[1]), d = std::hypot(r - out, tip[2] - up);
    if (!(r > 1e-6))
      return std::string(
          "the wrist is on the axis of the base, which can turn freely there (a singular pose)");
    if (d > l1 + l2)
      return "the wrist is " + fixed(d - l1 - l2, 3) + " mm beyond the reach of the arm, " +
             fixed(l1 + l2, 3) + " mm";
    if (d < std::abs(l1 - l2))
      return "the wrist is " + fixed(std::abs(l1 - l2) - d, 3) +
             " mm nearer to the shoulder than the folded arm gets";
    const double c = (d * d + l1 * l1 - l2 * l2) / (2 * d * l1);
    if (!((1 - c) * (1 + c) > 1e-12))
      return "the arm is " + std::string(d > l1 ? "stretched" : "folded") +
             ": its joints would need an infinite speed there (a singular pose)";
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3&) const {
    const double r = out + l1 * std::cos(q[1]) + l2 * std::cos(q[2]);
    if (!(r > 0))
      return unexpected(
          ReachError{"the wrist is " + fixed(-r, 3) + " mm behind the axis of the base"});
    AxisValues tip;
    tip[Axis::x] = r * std::cos(q[0]);
    tip[Axis::y] = r * std::sin(q[0]);
    tip[Axis::z] = up + l1 * std::sin(q[1]) + l2 * std::sin(q[2]);
    tip[Axis::a] = differential ? (q[3] + q[4]) / 2 : q[3];
    tip[Axis::b] = differential ? (q[3] - q[4]) / 2 : q[4];
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_scorbot(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRRRR");
  Scorbot model;
  model.out = p.length("base_out", model.out);
  model.up = p.length("base_up", model.up);
  model.l1 = p.positive("l1", model.l1);
  model.l2 = p.positive("l2", model.l2);
  model.follows = p.drawn("platform");
  model.differential = input.table.boolean("differential", false);
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
