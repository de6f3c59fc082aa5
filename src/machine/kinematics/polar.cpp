// Machines whose table turns under the program's X and Y:
//
//   polar        x = r cos θ, y = r sin θ. Joints r, Z, θ; pose X Y Z. θ is the turn nearest to
//                where it is; r = 0 is singular
//   rotated-xy   the axes X Y are turned by the C word: (qx, qy) = Rz(C) (x, y). Joints X Y Z C
//
// In both the spindle stays upright over the bed, so a tool offset along X of a polar machine
// points along r.
#include "machine/kinematics/model.h"
#include "machine/kinematics/parameters.h"

namespace aircut::machine {

namespace {

struct Polar : BasicModel {
  static constexpr int joints = 3;

  std::string_view type() const { return "polar"; }
  AxisSet axes() const { return axes_of("XYZ"); }
  bool rotary(int joint) const { return joint == 2; }
  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    if (offset[Axis::y] != 0)
      return std::string(
          "a tool offset in Y is not possible on this machine: the tool would miss the centre");
    return wrong_offset_beyond(offset, 3, "tools have lengths along X and Z");
  }

  template <class T>
  std::array<T, joints> solve(const PoseWords<T>& tip, const Vec3& tool, int) const {
    using std::atan2;
    using std::sqrt;
    return {sqrt(square(tip[0]) + square(tip[1])) + T(tool.x()), tip[2] + T(tool.z()),
            atan2(tip[1], tip[0])};
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3&, int) const {
    const double r = std::hypot(tip[0], tip[1]);
    if (r > 1e-6) return std::nullopt;
    return "the tip is " + fixed(r, 3) +
           " mm from the table's centre, where the table can turn freely (a singular pose)";
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const double r = q[0] - tool.x();
    if (!(r > 0))
      return unexpected(ReachError{"the tip is " + fixed(-r, 3) +
                                   " mm behind the table's centre; it works in front of it"});
    AxisValues tip;
    tip[Axis::x] = r * std::cos(q[2]);
    tip[Axis::y] = r * std::sin(q[2]);
    tip[Axis::z] = q[1] - tool.z();
    return tip;
  }
};

struct RotatedXY : BasicModel {
  static constexpr int joints = 4;

  std::string_view type() const { return "rotated-xy"; }
  AxisSet axes() const { return axes_of("XYZC"); }

  template <class T>
  std::array<T, joints> solve(const PoseWords<T>& tip, const Vec3& tool, int) const {
    using std::cos;
    using std::sin;
    const T c = cos(tip[5]), s = sin(tip[5]);
    return {c * tip[0] - s * tip[1] + T(tool.x()), s * tip[0] + c * tip[1] + T(tool.y()),
            tip[2] + T(tool.z()), tip[5]};
  }

  std::optional<std::string> why_not(const PoseWords<double>&, const Vec3&, int) const {
    return std::nullopt;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const double c = std::cos(q[3]), s = std::sin(q[3]), x = q[0] - tool.x(), y = q[1] - tool.y();
    AxisValues tip;
    tip[Axis::x] = c * x + s * y;
    tip[Axis::y] = c * y - s * x;
    tip[Axis::z] = q[2] - tool.z();
    tip[Axis::c] = q[3];
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_polar(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTR");
  return p.good() ? make_model(Polar{}) : nullptr;
}

std::shared_ptr<const Kinematics> read_rotated_xy(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTTR");
  return p.good() ? make_model(RotatedXY{}) : nullptr;
}

}  // namespace aircut::machine
