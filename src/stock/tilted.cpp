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

/// Real roots of a x² + 2 b x + c, ascending or not; the number of them.
int roots(double a, double b, double c, double out[2]) {
  if (std::abs(a) < 1e-14) {
    if (std::abs(b) < 1e-14) return 0;
    out[0] = -c / (2 * b);
    return 1;
  }
  const double q = b * b - a * c;
  if (q < 0) return 0;
  const double s = b < 0 ? std::sqrt(q) - b : -std::sqrt(q) - b;  // no cancellation
  out[0] = s / a;
  if (s == 0) return 1;
  out[1] = c / s;
  return 2;
}

}  // namespace

/// The extent found so far, with the cutter's outward normals there.
struct TiltedSweep::Ends {
  double a = std::numeric_limits<double>::infinity(), b = -a;
  Vec3 normal_a = Vec3::Zero(), normal_b = Vec3::Zero();

  template <class Normal>
  void offer(double tau, Normal normal) {
    if (tau < a) {
      a = tau;
      normal_a = normal();
    }
    if (tau > b) {
      b = tau;
      normal_b = normal();
    }
  }
};

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
  const auto flat = [&](const Vec3& v) { return Vec3(v - axis_.dot(v) * axis_); };
  const Vec3 rel = flat(middle - start_), way = flat(travel_);
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp(rel.dot(way) / length2, 0.0, 1.0) : 0;
  return (rel - t * way).norm() > outline_->radius() + half.norm() + margin;
}

// Proof that no point between two places is touched.
bool TiltedSweep::misses(const Vec3& from, const Vec3& to) const {
  const double a = axis_.dot(from), b = axis_.dot(to);
  if (std::max(a, b) < tip_low_ + outline_->low() - margin) return true;
  if (std::min(a, b) > tip_high_ + outline_->high() + margin) return true;
  const auto flat = [&](const Vec3& v) { return Vec3(v - axis_.dot(v) * axis_); };
  const Vec3 rel = flat((from + to) / 2 - start_), way = flat(travel_);
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp(rel.dot(way) / length2, 0.0, 1.0) : 0;
  return (rel - t * way).norm() > outline_->radius() + flat(to - from).norm() / 2 + margin;
}

bool TiltedSweep::holds(const Vec3& p) const {
  const Vec3 way = travel_ - axis_.dot(travel_) * axis_;
  const double length2 = way.squaredNorm();
  const double nearest = length2 > 0 ? std::clamp((p - start_).dot(way) / length2, 0.0, 1.0) : 0;
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

void TiltedSweep::band_ends(const Band& band, const Vec3& origin, int ray_axis, Ends& ends) const {
  const Vec3 u = Vec3::Unit(ray_axis), &d = travel_, rel = origin - start_;
  const double zu = axis_[ray_axis], zd = axis_.dot(d), zc = axis_.dot(rel);
  const bool ball = band.arc > 0;
  const double growth = ball ? 0 : (band.r1 - band.r0) / (band.z1 - band.z0);
  // Vectors from the axis, or from the sphere's middle.
  const Vec3 U = ball ? u : Vec3(u - zu * axis_), D = ball ? d : Vec3(d - zd * axis_);
  const Vec3 P = ball ? Vec3(rel - band.f * axis_) : Vec3(rel - zc * axis_);
  const double r = ball ? band.arc : band.r0 + growth * (zc - band.z0);
  const double ru = growth * zu, rd = growth * zd;  // the radius is r + ru τ − rd t
  const double A = U.dot(U) - ru * ru, B = ru * rd - U.dot(D), C = D.dot(D) - rd * rd;
  const double E = U.dot(P) - r * ru, G = r * rd - D.dot(P), H = P.dot(P) - r * r;

  const auto height = [&](double tau, double t) { return zc + zu * tau - zd * t; };
  const auto in_strip = [&](double tau, double t) {
    const double z = height(tau, t);
    return z >= band.z0 - slack && z <= band.z1 + slack;
  };
  const auto side = [&](double tau, double t) {
    const Vec3 n = P + tau * U - t * D;
    const double length = n.norm();
    if (!(length > 0)) return axis_;
    return ball ? Vec3(n / length) : Vec3((n / length - growth * axis_).normalized());
  };
  // On an edge of the band in the middle of the path, the normal is across the travel.
  const auto edge = [&](double tau, double t, const Vec3& face) {
    const Vec3 n = side(tau, t);
    const double v1 = n.dot(d), v2 = face.dot(d);
    if (v1 * v2 < 0) return Vec3((n * std::abs(v2) + face * std::abs(v1)).normalized());
    return std::abs(v1) <= std::abs(v2) ? n : face;
  };
  double x[2];

  if (std::abs(C) > 1e-14)
    for (int i = roots(A - B * B / C, E - B * G / C, H - G * G / C, x); i-- > 0;) {
      const double t = -(B * x[i] + G) / C;
      if (t >= 0 && t <= 1 && in_strip(x[i], t)) ends.offer(x[i], [&] { return side(x[i], t); });
    }
  for (const double t : {0.0, 1.0}) {
    for (int i = roots(A, B * t + E, C * t * t + 2 * G * t + H, x); i-- > 0;)
      if (in_strip(x[i], t)) ends.offer(x[i], [&] { return side(x[i], t); });
    if (std::abs(zu) > 1e-12)
      for (const double z : {band.z0, band.z1}) {
        const double tau = (z - zc + zd * t) / zu;
        if (A * tau * tau + 2 * (B * t + E) * tau + C * t * t + 2 * G * t + H <= slack)
          ends.offer(tau, [&] { return z == band.z0 ? Vec3(-axis_) : axis_; });
      }
  }
  for (const double z : {band.z0, band.z1}) {
    const Vec3 face = z == band.z0 ? Vec3(-axis_) : axis_;
    if (std::abs(zu) > std::abs(zd)) {  // τ = p + q t on this border
      const double p = (z - zc) / zu, q = zd / zu;
      for (int i = roots(A * q * q + 2 * B * q + C, A * p * q + B * p + E * q + G,
                         A * p * p + 2 * E * p + H, x);
           i-- > 0;)
        if (x[i] >= 0 && x[i] <= 1)
          ends.offer(p + q * x[i], [&] { return edge(p + q * x[i], x[i], face); });
    } else if (std::abs(zd) > 1e-12) {  // t = p + q τ
      const double p = (zc - z) / zd, q = zu / zd;
      for (int i = roots(A + 2 * B * q + C * q * q, B * p + C * p * q + E + G * q,
                         C * p * p + 2 * G * p + H, x);
           i-- > 0;) {
        const double t = p + q * x[i];
        if (t >= 0 && t <= 1) ends.offer(x[i], [&] { return edge(x[i], t, face); });
      }
    }
  }
}

bool TiltedSweep::chords(const Lattice& lattice, const std::array<int, 3>& brick, Family family,
                         int row, const std::uint16_t* lo, const std::uint16_t* hi,
                         Chords& out) const {
  const int axis = index_of(family), lane_axis = axis == 0 ? 1 : 0, row_axis = axis == 2 ? 1 : 2;
  const Vec3 low = lattice.brick_size() * Vec3(brick[0], brick[1], brick[2]);
  bool touched = false;
  for (int lane = 0; lane < cells; ++lane) {
    out.a[lane] = out.b[lane] = 0;
    if (lo && lo[lane] >= hi[lane]) continue;
    Vec3 origin = low;
    origin[lane_axis] += (lane + 0.5) * lattice.pitch;
    origin[row_axis] += (row + 0.5) * lattice.pitch;
    const double q = lattice.quantum();
    const Vec3 along = Vec3::Unit(axis);
    if (misses(origin + (lo ? lo[lane] : 0) * q * along,
               origin + (hi ? hi[lane] : brick_quanta) * q * along))
      continue;
    Ends ends;
    for (const Band& band : bands_) band_ends(band, origin, axis, ends);
    const auto quanta = [&](double mm) {
      return static_cast<std::int32_t>(
          std::clamp(mm / lattice.quantum(), 0.0, double{brick_quanta}) + 0.5);
    };
    const std::int32_t a = quanta(ends.a), b = quanta(ends.b);
    if (!(ends.a < ends.b) || a >= b) continue;
    if (lo && (a > hi[lane] || b < lo[lane])) continue;
    touched = true;
    out.a[lane] = a;
    out.b[lane] = b;
    out.normal_a[lane] = encode_normal(-ends.normal_a);
    out.normal_b[lane] = encode_normal(-ends.normal_b);
  }
  return touched;
}

}  // namespace aircut::stock
