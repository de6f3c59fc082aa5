// lathe-vertical: a lathe with an upright spindle C that turns the work, a cross slide X and a
// slide Z (kinematics.md a.5).
//
//   a0 X of the spindle's axis in the bed, d0 height of the chuck's face, dw of work zero above it;
//   b0 height of the rail, b2, b3 zero points of the slides; e the tool's offset across the X-Z
//   plane, at its radial offset, lt its length
//
//   ΔX = b2 + X + at − a0,  ΔZ = b0 + b3 + Z − lt − d0 − dw
//   x = cos C ΔX − sin C e,  y = sin C ΔX + cos C e,  z = ΔZ
//
// Inverse: ΔX = ±√(x² + y² − e²), the side that is kept, and C turns (ΔX, e) to (x, y): one angle
// of two products, C = atan2(y ΔX − x e, x ΔX + y e). Joints X, Z, C; pose X Y Z of the tip on the
// work.
#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

struct LatheVertical : BasicModel {
  static constexpr int joints = 3;
  double a0 = 0, d0 = 350, dw = 60, b0 = 900, b2 = 420, b3 = 250, e = 0, at = -55, lt = 140;

  std::string_view type() const { return "lathe-vertical"; }
  AxisSet axes() const { return axes_of("XYZ"); }
  bool rotary(int joint) const { return joint == 2; }
  static constexpr std::array<int, 2> branches() { return {1, -1}; }
  int branch_of(const JointVector& q) const { return b2 + q[0] + at - a0 >= 0 ? 1 : -1; }

  // The tool's offset is fixed to the slide; a longer tool is a larger lt.
  template <class T>
  std::array<T, joints> solve(const PoseWords<T>& tip, const Vec3& tool, int side) const {
    using std::atan2;
    using std::sqrt;
    const double across = e - tool.y();
    const T far2 = square(tip[0]) + square(tip[1]);
    const T dx = T(side) * (across == 0 ? sqrt(far2) : sqrt(far2 - T(across * across)));
    const T y = tip[1] * dx - tip[0] * T(across), x = tip[0] * dx + tip[1] * T(across);
    return {dx + T(a0 + tool.x() - b2 - at), tip[2] + T(d0 + dw + lt + tool.z() - b0 - b3),
            atan2(y, x)};
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    const double r = std::hypot(tip[0], tip[1]), across = std::abs(e - tool.y());
    if (r < across)
      return "the point is " + fixed(r, 3) + " mm from the spindle's axis; the tool stays " +
             fixed(across, 3) + " mm beside it";
    if (!((r - across) * (r + across) > 1e-12))
      return std::string(
          "the tool is over the spindle's axis, where C can turn freely (a singular pose)");
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const double dx = b2 + q[0] + at - a0 - tool.x(), across = e - tool.y();
    AxisValues tip;
    tip[Axis::x] = std::cos(q[2]) * dx - std::sin(q[2]) * across;
    tip[Axis::y] = std::sin(q[2]) * dx + std::cos(q[2]) * across;
    tip[Axis::z] = b0 + b3 + q[1] - lt - d0 - dw - tool.z();
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_lathe_vertical(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTR");
  LatheVertical model;
  const std::array<std::pair<const char*, double LatheVertical::*>, 9> keys = {
      {{"a0", &LatheVertical::a0},
       {"d0", &LatheVertical::d0},
       {"dw", &LatheVertical::dw},
       {"b0", &LatheVertical::b0},
       {"b2", &LatheVertical::b2},
       {"b3", &LatheVertical::b3},
       {"e", &LatheVertical::e},
       {"at", &LatheVertical::at},
       {"lt", &LatheVertical::lt}}};
  for (const auto& [key, value] : keys) model.*value = p.length(key, model.*value);
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
