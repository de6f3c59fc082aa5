#include "stock/sweep.h"

#include <algorithm>
#include <cmath>

namespace aircut::stock {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double margin = 1e-5;       // mm, more than the kernels' rounding
constexpr double shortest = 1e-7;     // mm in plan: what is less is a plunge
constexpr double at_a_corner = 1e-4;  // mm: this near to two faces is at their edge

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

/// A face of the cutter in (radius, height): its outward normal, and how far a point is from it.
struct Face {
  double distance, nr, nz;
};

/// The two faces nearest to a point of the surface.
std::array<Face, 2> nearest_faces(const ShapeF& shape, double d, double z) {
  std::array<Face, 2> best = {Face{1e9, 1, 0}, Face{1e9, 1, 0}};
  const auto offer = [&](double distance, double nr, double nz) {
    const Face face{distance, nr, nz};
    if (distance < best[0].distance) {
      best[1] = best[0];
      best[0] = face;
    } else if (distance < best[1].distance) {
      best[1] = face;
    }
  };
  const auto level_face = [&](double height, double radius, double nz) {
    if (radius > 0) offer(std::hypot(z - height, std::max(d - radius, 0.0)), 0, nz);
  };
  level_face(shape.low, shape.bands.front().r0, -1);
  level_face(shape.high, shape.bands.back().r1, 1);
  for (const BandF& b : shape.bands) {
    const double beyond = std::max({b.z0 - z, z - b.z1, 0.0});
    if (b.arc > 0) {
      const double r = d - b.e, q = z - b.f, n = std::hypot(r, q);
      if (n > 0) offer(std::hypot(n - b.arc, beyond), r / n, q / n);
      continue;
    }
    const double dr = b.r1 - b.r0, dz = b.z1 - b.z0, n = std::hypot(dr, dz);
    offer(std::hypot(((d - b.r0) * dz - (z - b.z0) * dr) / n, beyond), dz / n, -dr / n);
  }
  return best;
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

NormalCode wall_normal(const LocalSweep& sweep, Family family, int row, int lane, int end,
                       float s) {
  const double across = (lane + 0.5) * sweep.pitch, line = (row + 0.5) * sweep.pitch;
  const double along = end * sweep.pitch / quanta_per_cell;
  Vec3 p(along, across, line);
  if (family == Family::y) p = {across, along, line};
  if (family == Family::z) p = {across, line, along};
  const Vec2 u(sweep.u[0], sweep.u[1]);
  const double t = s;
  const Vec2 out(p.x() - sweep.foot[0] - t * u.x(), p.y() - sweep.foot[1] - t * u.y());
  const double d = out.norm();
  const Vec2 radial = d > 1e-12 ? Vec2(out / d) : Vec2(1, 0);
  double z = p.z() - sweep.foot[2] - sweep.slope * t;
  // A plunge holds the cutter at all heights up to its rise: the side that counts is the widest.
  if (sweep.rise > 0)
    z = std::clamp<double>(z < sweep.shape->wall_low ? z : sweep.shape->wall_low, z - sweep.rise,
                           z);
  const auto [first, second] = nearest_faces(*sweep.shape, d, z);
  double nr = first.nr, nz = first.nz;
  // On an edge the swept surface's normal is the one in the edge's fan that is across the travel.
  if (second.distance < at_a_corner) {
    const double c = radial.dot(u);
    const double v1 = first.nr * c + first.nz * sweep.slope;
    const double v2 = second.nr * c + second.nz * sweep.slope;
    const bool moving = t > sweep.s0 + at_a_corner && t < sweep.s1 - at_a_corner;
    if (moving && v1 * v2 < 0) {
      nr = first.nr * std::abs(v2) + second.nr * std::abs(v1);
      nz = first.nz * std::abs(v2) + second.nz * std::abs(v1);
    } else if (moving && std::abs(v2) < std::abs(v1)) {
      nr = second.nr;
      nz = second.nz;
    }
  }
  const Vec3 outward(-nr * radial.x(), -nr * radial.y(), -nz);
  return encode_normal(outward.normalized());
}

}  // namespace aircut::stock
