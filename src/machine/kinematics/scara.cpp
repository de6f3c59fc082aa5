// scara: a column, two level links, a quill and a turning flange.
//
//     d1 column, l1 inner link, d3 from it up to the outer one, l2 outer link, q3 lowers the quill,
//     d5 from the quill down to the tip, d6 from its axis out to the tip:
//
//   x = l1 c1 + l2 c12 + d6 cC,  y likewise with sines,  z = d1 + d3 − q3 − d5,  C = θ1 + θ2 + θ4
//
// Inverse: with the tip offset taken off and r the distance left,
//   θ2 = ±acos((r² − l1² − l2²) / (2 l1 l2)),  θ1 = atan2(y, x) − atan2(l2 s2, l1 + l2 c2)
// the side of the elbow is kept. Joints θ1, θ2, q3, θ4; pose X Y Z C.
#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

struct Scara : BasicModel {
  static constexpr int joints = 4;
  double d1 = 490, l1 = 340, d3 = 50, l2 = 250, d5 = 50, d6 = 50;

  std::string_view type() const { return "scara"; }
  AxisSet axes() const { return axes_of("XYZC"); }
  bool rotary(int joint) const { return joint < 2; }
  // C counts its turns, so θ4 takes what the turns of the others leave.
  void settle(const PoseWords<double>& tip, JointVector& q) const { q[3] = tip[5] - q[0] - q[1]; }
  static constexpr std::array<int, 2> branches() { return {1, -1}; }
  int branch_of(const JointVector& q) const { return std::sin(q[1]) >= 0 ? 1 : -1; }

  // Axis of the quill; the tool turns with the flange.
  template <class T>
  Vector<T> quill(const PoseWords<T>& tip, const Vec3& tool) const {
    using std::cos;
    using std::sin;
    const T c = cos(tip[5]), s = sin(tip[5]);
    const T x(tool.x() - d6), y(tool.y());
    return {tip[0] + x * c - y * s, tip[1] + x * s + y * c, tip[2] + T(tool.z())};
  }

  template <class T>
  std::array<T, joints> solve(const PoseWords<T>& tip, const Vec3& tool, int side) const {
    using std::acos;
    using std::atan2;
    using std::sqrt;
    const Vector<T> p = quill(tip, tool);
    const T D = (square(p[0]) + square(p[1]) - T(l1 * l1 + l2 * l2)) * T(1 / (2 * l1 * l2));
    const T e(side), lift = e * T(l2) * sqrt((T(1) - D) * (T(1) + D)), reach = T(l1) + T(l2) * D;
    std::array<T, joints> q{};
    q[1] = e * acos(D);
    // One angle of two products: no jump where either of them passes ±180.
    q[0] = atan2(p[1] * reach - p[0] * lift, p[0] * reach + p[1] * lift);
    q[2] = T(d1 + d3 - d5) - p[2];
    q[3] = tip[5] - q[0] - q[1];
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    const Vector<double> p = quill(tip, tool);
    const double r = std::hypot(p[0], p[1]);
    if (r > l1 + l2)
      return "the quill is " + fixed(r - l1 - l2, 3) + " mm beyond the reach of the arm, " +
             fixed(l1 + l2, 3) + " mm";
    if (r < std::abs(l1 - l2))
      return "the quill is " + fixed(std::abs(l1 - l2) - r, 3) +
             " mm nearer to the column than the folded arm gets";
    const double D = (r * r - l1 * l1 - l2 * l2) / (2 * l1 * l2);
    if (!((1 - D) * (1 + D) > 1e-12) || !(r > 1e-6))
      return "the arm is " + std::string(D > 0 ? "stretched" : "folded") +
             ": its joints would need an infinite speed there (a singular pose)";
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const double c = q[0] + q[1] + q[3], x = d6 - tool.x();
    AxisValues tip;
    tip[Axis::x] =
        l1 * std::cos(q[0]) + l2 * std::cos(q[0] + q[1]) + x * std::cos(c) + tool.y() * std::sin(c);
    tip[Axis::y] =
        l1 * std::sin(q[0]) + l2 * std::sin(q[0] + q[1]) + x * std::sin(c) - tool.y() * std::cos(c);
    tip[Axis::z] = d1 + d3 - q[2] - d5 - tool.z();
    tip[Axis::c] = c;
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_scara(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRTR");
  Scara model;
  model.d1 = p.length("d1", model.d1);
  model.l1 = p.positive("l1", model.l1);
  model.d3 = p.length("d3", model.d3);
  model.l2 = p.positive("l2", model.l2);
  model.d5 = p.length("d5", model.d5);
  model.d6 = p.length("d6", model.d6);
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
