// Chords of a ray through a sweep in any direction.
//
// With the ray o + τ u and the tip S + t D (0 ≤ t ≤ 1), the points of the plane (τ, t) at which the
// ray's point lies in one band of the cutter are
//     F(τ, t) = A τ² + 2 B τ t + C t² + 2 E τ + 2 G t + H ≤ 0   (a conic: the band is a cone, a
//     cylinder or a sphere)      z0 ≤ z(τ, t) ≤ z1               (a strip: the band's heights)
// and 0 ≤ t ≤ 1. This region is convex, since the band is; the chord of the band's sweep is its
// extent in τ. An extreme point of it is one of
//   * where F = 0 and ∂F/∂t = 0;
//   * where F = 0 on one of the four straight borders;
//   * where two of the borders cross and F ≤ 0.
// All of them are solved in closed form, those that lie in the region count. The chord of a convex
// body is the hull of those of its bands. Corner arcs with e > 0 have no such conic; they are
// replaced by cones that leave the arc by less than half a micrometre.
#include "stock/tilted.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::stock {
namespace {

constexpr double margin = 1e-5;          // mm, more than rounding
constexpr double corner_bound = 0.0005;  // mm, of cones instead of an arc
constexpr double slack = 1e-9;           // of comparisons, mm

/// A corner arc as cones: points on the arc at both ends, between them a little outside, so that
/// the arc lies in the middle of the error.
void append_cones(const Band& arc, std::vector<Band>& out) {
  const double from = std::atan2(arc.z0 - arc.f, arc.r0 - arc.e);
  const double to = std::atan2(arc.z1 - arc.f, arc.r1 - arc.e);
  const double step = 2 * std::acos(std::max(1 - corner_bound / arc.arc, 0.5));
  const int count = std::max(2, static_cast<int>(std::ceil((to - from) / step)));
  const double outside = arc.arc + corner_bound / 2;
  double r = arc.r0, z = arc.z0;
  for (int i = 1; i <= count; ++i) {
    const double angle = from + (to - from) * i / count;
    const bool last = i == count;
    const double next_r = last ? arc.r1 : arc.e + outside * std::cos(angle);
    const double next_z = last ? arc.z1 : std::min(arc.f + outside * std::sin(angle), arc.z1);
    if (next_z > z + slack) {
      out.push_back({z, next_z, r, next_r});
      z = next_z;
    }
    r = next_r;
  }
}

/// What a band is to all rays along one axis.
TiltedBand to_rays(const Band& band, const Vec3& axis, const Vec3& travel, int ray_axis) {
  TiltedBand out{};
  out.z0 = band.z0;
  out.z1 = band.z1;
  out.f = band.f;
  out.ball = band.arc > 0;
  out.zu = axis[ray_axis];
  out.zd = axis.dot(travel);
  out.growth = out.ball ? 0 : (band.r1 - band.r0) / (band.z1 - band.z0);
  out.radius = out.ball ? band.arc : band.r0 - out.growth * band.z0;
  out.ru = out.growth * out.zu;
  out.rd = out.growth * out.zd;
  // Seen from the axis, or from the sphere's middle.
  const double across = out.ball ? 0 : 1;
  out.A = 1 - across * out.zu * out.zu - out.ru * out.ru;
  out.B = out.ru * out.rd - (travel[ray_axis] - across * out.zu * out.zd);
  out.C = travel.squaredNorm() - across * out.zd * out.zd - out.rd * out.rd;
  out.per_A = 1 / out.A;
  if (std::abs(out.C) > 1e-14) {
    out.per_C = 1 / out.C;
    out.hull = out.A - out.B * out.B * out.per_C;
    out.per_hull = 1 / out.hull;
  }
  out.along_ray = std::abs(out.zu) > std::abs(out.zd);
  if (out.along_ray) {
    out.q = out.zd / out.zu;
    out.border = (out.A * out.q + 2 * out.B) * out.q + out.C;
  } else if (std::abs(out.zd) > 1e-12) {
    out.q = out.zu / out.zd;
    out.border = out.A + (2 * out.B + out.C * out.q) * out.q;
  }
  out.per_border = 1 / out.border;
  return out;
}

}  // namespace

TiltedSweep::TiltedSweep(const Outline& outline, const Vec3& start, const Vec3& end,
                         const Vec3& axis)
    : outline_(&outline), start_(start), travel_(end - start), axis_(axis.normalized()) {
  for (const Band& band : outline.bands()) {
    if (band.arc > 0 && band.e > 0)
      append_cones(band, bands_);
    else
      bands_.push_back(band);
  }
  const Vec3 disc = (Vec3::Ones() - axis_.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  for (const Band& band : bands_) {
    const Vec3 wide = std::max(band.r0, band.r1) * disc + Vec3::Constant(margin);
    for (const Vec3& tip : {start, end})
      for (const double z : {band.z0, band.z1}) {
        box_.extend(Vec3(tip + z * axis_ - wide));
        box_.extend(Vec3(tip + z * axis_ + wide));
      }
  }
  way_ = travel_ - axis_.dot(travel_) * axis_;
  way2_ = way_.squaredNorm();
  per_way2_ = way2_ > 0 ? 1 / way2_ : 0;
  for (int axis_of_rays = 0; axis_of_rays < 3; ++axis_of_rays)
    for (const Band& band : bands_)
      ray_bands_[static_cast<std::size_t>(axis_of_rays)].push_back(
          to_rays(band, axis_, travel_, axis_of_rays));
  const double tip0 = axis_.dot(start), tip1 = axis_.dot(end);
  tip_low_ = std::min(tip0, tip1);
  tip_high_ = std::max(tip0, tip1);
}

bool TiltedSweep::misses(const Box3& box) const {
  if (!box_.intersects(box)) return true;
  // Along the axis: above the highest or below the lowest place of the cutter.
  const Vec3 middle = box.center(), half = box.sizes() / 2;
  const double along = axis_.dot(middle), reach = axis_.cwiseAbs().dot(half);
  if (along + reach < tip_low_ + outline_->low() - margin) return true;
  if (along - reach > tip_high_ + outline_->high() + margin) return true;
  // Across it: the distance of the middle from the path, seen along the axis.
  const Vec3 from = middle - start_, rel = from - axis_.dot(from) * axis_;
  const double t = std::clamp(rel.dot(way_) * per_way2_, 0.0, 1.0);
  const double apart = outline_->radius() + half.norm() + margin;
  return (rel - t * way_).squaredNorm() > apart * apart;
}

bool TiltedSweep::holds(const Vec3& p) const {
  const double nearest = std::clamp((p - start_).dot(way_) * per_way2_, 0.0, 1.0);
  for (const double t : {nearest, 0.0, 1.0, 0.5}) {
    const Vec3 rel = p - start_ - t * travel_;
    const double z = axis_.dot(rel);
    if (z < outline_->low() + margin || z > outline_->high() - margin) continue;
    const double d = (rel - z * axis_).norm() + margin;
    if (z >= outline_->floor_at(d) + margin && z <= outline_->roof_at(d) - margin) return true;
  }
  return false;
}

bool TiltedSweep::takes_all(const Box3& box) const {
  // The sweep is convex: it holds the box when it holds the corners.
  for (int c = 0; c < 8; ++c)
    if (!holds(box.corner(static_cast<Box3::CornerType>(c)))) return false;
  return true;
}

// The cutter's outward normal at the end of a chord, of any length.
Vec3 TiltedSweep::normal_at(const Vec3& rel, double t, std::int64_t place) const {
  const auto on = static_cast<TiltedPlace>(place % 8);
  if (on == TiltedPlace::low_face) return -axis_;
  if (on == TiltedPlace::high_face) return axis_;
  const Band& band = bands_[static_cast<std::size_t>(place / 8)];
  const Vec3 tip = rel - t * travel_;
  Vec3 side = tip - (band.arc > 0 ? band.f : axis_.dot(tip)) * axis_;
  if (band.arc == 0 && band.r0 != band.r1)
    side -= (band.r1 - band.r0) / (band.z1 - band.z0) * side.norm() * axis_;
  if (on == TiltedPlace::side) return side;
  // On an edge of the band in the middle of the path, the normal is across the travel.
  const Vec3 face = on == TiltedPlace::low_edge ? Vec3(-axis_) : axis_;
  const double v1 = side.dot(travel_), v2 = face.dot(travel_);
  if (v1 * v2 < 0) return side * std::abs(v2) + face * std::abs(v1);
  return std::abs(v1) <= std::abs(v2) * side.norm() ? side : face;
}

bool TiltedSweep::chords(const Lattice& lattice, const std::array<int, 3>& brick, Family family,
                         int row, const std::uint16_t* lo, const std::uint16_t* hi,
                         Chords& out) const {
  const int axis = index_of(family), lane_axis = axis == 0 ? 1 : 0, row_axis = axis == 2 ? 1 : 2;
  Vec3 rel = lattice.brick_size() * Vec3(brick[0], brick[1], brick[2]) - start_;
  rel[lane_axis] += 0.5 * lattice.pitch;
  rel[row_axis] += (row + 0.5) * lattice.pitch;
  const double tip = axis_.dot(start_);
  const TiltedRow place{.pitch = lattice.pitch,
                        .quantum = lattice.quantum(),
                        .u = rel[axis],
                        .across = rel[lane_axis],
                        .square = rel.squaredNorm(),
                        .z = axis_.dot(rel),
                        .z_l = axis_[lane_axis],
                        .z_u = axis_[axis],
                        .d = travel_.dot(rel),
                        .d_l = travel_[lane_axis],
                        .way = way_.dot(rel),
                        .way_l = way_[lane_axis],
                        .way_u = way_[axis],
                        .way2 = way2_,
                        .per_way2 = per_way2_,
                        .low = tip_low_ - tip + outline_->low(),
                        .high = tip_high_ - tip + outline_->high(),
                        .radius = outline_->radius(),
                        .seen = std::sqrt(std::max(1 - axis_[axis] * axis_[axis], 0.0))};
  TiltedEnds ends;
  const std::vector<TiltedBand>& bands = ray_bands_[static_cast<std::size_t>(axis)];
  std::uint32_t left = kernels().tilted(bands.data(), bands.size(), place, lo, hi, ends);
  if (left == 0) return false;
  bool touched = false;
  const double per_quantum = 1 / place.quantum;
  const auto quanta = [&](double mm) {
    return static_cast<std::int32_t>(std::clamp(mm * per_quantum, 0.0, double{brick_quanta}) + 0.5);
  };
  for (int lane = 0; lane < cells; ++lane) {
    out.a[lane] = out.b[lane] = 0;
    if ((left >> lane & 1) == 0 || !(ends.a.tau[lane] < ends.b.tau[lane])) continue;
    const std::int32_t a = quanta(ends.a.tau[lane]), b = quanta(ends.b.tau[lane]);
    if (a >= b) continue;
    if (lo && (a > hi[lane] || b < lo[lane])) continue;
    touched = true;
    out.a[lane] = a;
    out.b[lane] = b;
    const auto direction = [&](const TiltedEnds::End& end) {
      Vec3 at = rel;
      at[lane_axis] += lane * lattice.pitch;
      at[axis] += end.tau[lane];
      return encode_normal(-normal_at(at, end.t[lane], end.place[lane]));
    };
    // Only where the material ends there afterwards (row.cpp).
    if (!lo || (a > lo[lane] && a <= hi[lane])) out.normal_a[lane] = direction(ends.a);
    if (!lo || (b >= lo[lane] && b < hi[lane])) out.normal_b[lane] = direction(ends.b);
  }
  return touched;
}

}  // namespace aircut::stock
