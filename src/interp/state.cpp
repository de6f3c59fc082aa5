// Frames (interp.md): tip = R(rotation) · (F(program) + g92) + work offset, where F is the
// program's frame (program_frame.cpp) and R turns X and Y about Z; the tool length offset stays
// outside.
#include "interp/state.h"

namespace aircut::interp {
namespace {

Vec3 xyz(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

void set_xyz(AxisValues& p, const Vec3& v) {
  p[Axis::x] = v[0];
  p[Axis::y] = v[1];
  p[Axis::z] = v[2];
}

}  // namespace

AxisValues to_work(const ModalState& state, const AxisValues& tip) {
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

AxisValues work_to_tip(const ModalState& state, const AxisValues& work) {
  AxisValues p = work;
  p += state.g92;
  if (state.rotation != 0) {
    const double c = std::cos(state.rotation), s = std::sin(state.rotation);
    const double x = p[Axis::x], y = p[Axis::y];
    p[Axis::x] = c * x - s * y;
    p[Axis::y] = s * x + c * y;
  }
  return p += state.work_offset;
}

AxisValues to_program(const ModalState& state, const AxisValues& tip) {
  AxisValues p = to_work(state, tip);
  if (state.frame.active()) set_xyz(p, state.frame.undo(xyz(p)));
  return p;
}

AxisValues to_tip(const ModalState& state, const AxisValues& program) {
  if (!state.frame.active()) return work_to_tip(state, program);
  AxisValues p = program;
  set_xyz(p, state.frame.apply(xyz(p)));
  return work_to_tip(state, p);
}

AxisSet moved_by(const ModalState& state, AxisSet named) {
  AxisSet moved = named;
  if (state.frame.active())
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (named.has(all_axes[static_cast<std::size_t>(j)]) && state.frame.linear()(i, j) != 0)
          moved.add(all_axes[static_cast<std::size_t>(i)]);
  if (state.rotation != 0 && (moved.has(Axis::x) || moved.has(Axis::y))) {
    moved.add(Axis::x);
    moved.add(Axis::y);
  }
  return moved;
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

bool swaps_sides(const ModalState& state) {
  if (!state.frame.active() || state.plane >= canon::Plane::uv) return false;
  const PlaneAxes axes = axes_of(state.plane);
  return state.frame.swaps_sides(static_cast<int>(index(axes.first)),
                                 static_cast<int>(index(axes.second)));
}

}  // namespace aircut::interp
