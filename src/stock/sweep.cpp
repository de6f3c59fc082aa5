#include "stock/sweep.h"

#include <algorithm>
#include <cmath>

namespace aircut::stock {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double margin = 1e-5;    // mm, more than the kernels' rounding
constexpr double upright = 1e-12;  // of the axis' unit vector from Z
constexpr double shortest = 1e-7;  // mm in plan: what is less is a plunge

double to_segment(const Sweep& sweep, const Vec2& p) {
  const Vec2 rel = p - sweep.start.head<2>();
  const double s = std::clamp(rel.dot(sweep.direction), 0.0, sweep.length);
  return (rel - s * sweep.direction).norm();
}

double to_square(const Vec2& p, const Vec2& low, double size) {
  const Vec2 inside = p.cwiseMax(low).cwiseMin(low + Vec2::Constant(size));
  return (p - inside).norm();
}

bool crosses(const Sweep& sweep, const Vec2& low, double size) {
  double from = 0, to = sweep.length;
  for (int a = 0; a < 2; ++a) {
    const double u = sweep.direction[a], p = low[a] - sweep.start[a], q = p + size;
    if (std::abs(u) < 1e-12) {
      if (p > 0 || q < 0) return false;
      continue;
    }
    from = std::max(from, std::min(p / u, q / u));
    to = std::min(to, std::max(p / u, q / u));
  }
  return from <= to;
}

}  // namespace

Sweep Sweep::of(const Outline& outline, const Piece& piece, const Lattice& lattice,
                std::size_t slot) {
  Sweep out;
  out.outline = &outline;
  out.start = piece.start - lattice.origin;
  out.end = piece.end - lattice.origin;
  out.slot = slot;
  out.tip_low = std::min(out.start.z(), out.end.z());
  out.tip_high = std::max(out.start.z(), out.end.z());
  if ((piece.axis - Vec3::UnitZ()).norm() > upright)
    out.tilted = std::make_shared<const TiltedSweep>(outline, out.start, out.end, piece.axis);
  const Vec2 travel = (out.end - out.start).head<2>();
  const double length = travel.norm();
  if (length > shortest) {
    out.length = length;
    out.direction = travel / length;
    out.slope = (out.end.z() - out.start.z()) / length;
    if (std::abs(out.slope) < 1e-12) out.slope = 0;
  }
  return out;
}

ColumnSweep ColumnSweep::of(const Sweep& sweep, const Lattice& lattice, int i, int j) {
  const Outline& outline = *sweep.outline;
  const double size = lattice.brick_size();
  const Vec2 low(i * size, j * size);
  ColumnSweep out;
  if (sweep.tilted) {
    // Only its box is known here; bricks ask it for more.
    const Box3& box = sweep.tilted->box();
    out.tilted = sweep.tilted.get();
    out.local.shape = &outline.floats();
    out.floor = box.min().z();
    out.roof = box.max().z();
    const bool apart = box.max().x() < low.x() || box.min().x() > low.x() + size ||
                       box.max().y() < low.y() || box.min().y() > low.y() + size;
    out.nearest = apart ? outline.radius() : 0;
    out.end_row = cells;
    return out;
  }
  double nearest = std::min(to_square(sweep.start.head<2>(), low, size),
                            to_square(sweep.end.head<2>(), low, size));
  double farthest = 0;
  for (const Vec2& corner : {Vec2(0, 0), Vec2(size, 0), Vec2(0, size), Vec2(size, size)}) {
    const double d = to_segment(sweep, low + corner);
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  if (crosses(sweep, low, size)) nearest = 0;
  out.nearest = std::max(nearest - margin, 0.0);
  out.floor = sweep.tip_low + outline.floor_at(std::min(out.nearest, outline.radius())) - margin;
  out.roof = sweep.tip_high + outline.roof_at(std::min(out.nearest, outline.radius())) + margin;
  farthest += margin;
  out.covers = farthest < outline.radius();
  if (out.covers) {
    out.cover_floor = sweep.tip_high + outline.floor_at(farthest) + margin;
    out.cover_roof = sweep.tip_low + outline.roof_at(farthest) - margin;
  }
  const double reach = outline.radius() + margin;
  const double y0 = std::min(sweep.start.y(), sweep.end.y()) - reach - low.y();
  const double y1 = std::max(sweep.start.y(), sweep.end.y()) + reach - low.y();
  out.first_row = static_cast<int>(std::clamp(y0 / lattice.pitch - 0.5, 0.0, double{cells}));
  out.end_row = static_cast<int>(std::clamp(y1 / lattice.pitch + 0.5, 0.0, double{cells}));
  // The foot: where the path is nearest to the middle of the square.
  const Vec2 middle = low + Vec2::Constant(size / 2);
  const double along =
      std::clamp((middle - sweep.start.head<2>()).dot(sweep.direction), 0.0, sweep.length);
  const Vec2 foot = sweep.start.head<2>() + along * sweep.direction - low;
  LocalSweep& local = out.local;
  local.shape = &outline.floats();
  local.pitch = lattice.pitch;
  local.foot[0] = foot.x();
  local.foot[1] = foot.y();
  local.foot[2] = sweep.length > 0 ? sweep.start.z() + sweep.slope * along : sweep.tip_low;
  local.u[0] = sweep.direction.x();
  local.u[1] = sweep.direction.y();
  local.slope = sweep.slope;
  local.s0 = -along;
  local.s1 = sweep.length - along;
  local.rise = sweep.length > 0 ? 0 : sweep.tip_high - sweep.tip_low;
  return out;
}

LocalSweep ColumnSweep::in_brick(const Lattice& lattice, int k) const {
  LocalSweep out = local;
  out.foot[2] -= k * lattice.brick_size();
  return out;
}

bool ColumnSweep::takes_all(double low, double high) const {
  return covers && low >= cover_floor && high <= cover_roof;
}

}  // namespace aircut::stock
