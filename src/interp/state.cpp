// Frames (interp.md): tip = R(rotation) · (program + g92) + work offset, where R turns X and Y
// about Z; the tool length offset stays outside.
#include "interp/state.h"

namespace aircut::interp {

AxisValues to_program(const ModalState& state, const AxisValues& tip) {
  AxisValues p = tip;
  p -= state.work_offset;
  if (state.rotation != 0) {
    const double c = std::cos(state.rotation), s = std::sin(state.rotation);
    const double x = p[Axis::x], y = p[Axis::y];
    p[Axis::x] = c * x + s * y;
    p[Axis::y] = c * y - s * x;
  }
  return p -= state.g92;
}

AxisValues to_tip(const ModalState& state, const AxisValues& program) {
  AxisValues p = program;
  p += state.g92;
  if (state.rotation != 0) {
    const double c = std::cos(state.rotation), s = std::sin(state.rotation);
    const double x = p[Axis::x], y = p[Axis::y];
    p[Axis::x] = c * x - s * y;
    p[Axis::y] = s * x + c * y;
  }
  return p += state.work_offset;
}

PlaneAxes axes_of(canon::Plane plane) {
  switch (plane) {
    case canon::Plane::xy:
      return {Axis::x, Axis::y, Axis::z};
    case canon::Plane::zx:
      return {Axis::z, Axis::x, Axis::y};
    case canon::Plane::yz:
      return {Axis::y, Axis::z, Axis::x};
    case canon::Plane::uv:
      return {Axis::u, Axis::v, Axis::w};
    case canon::Plane::wu:
      return {Axis::w, Axis::u, Axis::v};
    case canon::Plane::vw:
      break;
  }
  return {Axis::v, Axis::w, Axis::u};
}

Vec3 plane_normal(const ModalState& state) {
  const std::size_t n = index(axes_of(state.plane).normal);
  Vec3 normal = Vec3::Zero();
  normal[static_cast<int>(n < 3 ? n : 2)] = 1;
  if (state.rotation == 0 || n == 2) return normal;
  return Eigen::AngleAxisd(state.rotation, Vec3::UnitZ()) * normal;
}

}  // namespace aircut::interp
