// Distance of two triangles, written so that it is never too large by more than rounding.
//
// The closest points of two disjoint triangles are on an edge of each, or a corner of one and the
// face of the other. All nine edge pairs and six corners are tried and the smallest wins; every
// candidate is a true pair of points, so the result cannot be too small. Edge pairs take the two
// lines' common normal and, whatever its condition, the four ends against the other edge as well:
// for edges at an angle θ the common normal is off by L·ε/θ and the ends by at most L·θ, so the
// better of the two is within L·√ε ≈ 1.5e-8 L of the truth. (Testing for slabs along the common
// normal, as is often done, can go wrong by whole millimetres for edges that are parallel up to
// rounding.)
//
// Triangles intersect when an edge of one passes through the other.
//
// Depth: two convex polytopes are apart by a shift along a face normal or along the cross product
// of an edge of each; for triangles also along the normals of the edges within their planes, which
// are needed when the planes coincide. The smallest overlap over these axes is the smallest shift.
#include "collide/triangle_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::collide {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Best {
  ClosestPoints points{infinity, Vec3::Zero(), Vec3::Zero()};

  void offer(const Vec3& on_a, const Vec3& on_b) {
    const double squared = (on_a - on_b).squaredNorm();
    if (squared < points.squared) points = {squared, on_a, on_b};
  }
};

double clamped(double share) { return std::min(std::max(share, 0.0), 1.0); }

/// Parameter in [0, 1] of the point of p + t·d nearest to q.
double nearest_parameter(const Vec3& p, const Vec3& d, const Vec3& q) {
  const double dd = d.squaredNorm();
  return dd > 0 ? clamped(d.dot(q - p) / dd) : 0.0;
}

/// Edges p + s·u of A and q + t·v of B, and the near end of each against the other; the far ends
/// are the near ends of the next edges. `uu`, `vv` are squared lengths, not 0.
void offer_edges(const Vec3& p, const Vec3& u, double uu, const Vec3& q, const Vec3& v, double vv,
                 Best& best) {
  const Vec3 w = p - q;
  const double uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const auto offer = [&](double s, double t) {
    const double squared = (w + s * u - t * v).squaredNorm();
    if (squared < best.points.squared) best.points = {squared, p + s * u, q + t * v};
  };
  offer(0, clamped(vw / vv));
  offer(clamped(-uw / uu), 0);
  const double denominator = uu * vv - uv * uv;
  const double above = uv * vw - vv * uw;
  if (!(above > 0 && above < denominator)) return;  // outside of A's edge: an end is nearer
  const double s = above / denominator;
  const double t = (vw + s * uv) / vv;
  if (t > 0 && t < 1) offer(s, t);
}

struct Face {
  Vec3 normal;
  double squared_normal;

  explicit Face(const Triangle& t)
      : normal((t[1] - t[0]).cross(t[2] - t[0])), squared_normal(normal.squaredNorm()) {}
};

/// True when p, a point of the triangle's plane or its projection, is inside of the three edges.
bool within(const Vec3& p, const Triangle& t, const Face& face) {
  for (std::size_t i = 0; i < 3; ++i)
    if (face.normal.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0) return false;
  return true;
}

/// Corner against face; gives the foot in the face.
bool foot_in_face(const Vec3& p, const Triangle& t, const Face& face, Vec3& foot) {
  if (!(face.squared_normal > 0) || !within(p, t, face)) return false;
  foot = p - face.normal * (face.normal.dot(p - t[0]) / face.squared_normal);
  return true;
}

/// Point where an edge of `edges` passes through `t`.
bool pierces(const Triangle& edges, const Triangle& t, const Face& face, Vec3& point) {
  if (!(face.squared_normal > 0)) return false;
  std::array<double, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) side[i] = face.normal.dot(edges[i] - t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    if ((side[i] > 0) == (side[k] > 0) || side[i] == side[k]) continue;
    point = edges[i] + (edges[k] - edges[i]) * (side[i] / (side[i] - side[k]));
    if (within(point, t, face)) return true;
  }
  return false;
}

struct Range {
  double low, high;
};
Range range_along(const Vec3& axis, const Triangle& t) {
  const double x = axis.dot(t[0]), y = axis.dot(t[1]), z = axis.dot(t[2]);
  return {std::min({x, y, z}), std::max({x, y, z})};
}

/// Keeps the axis with the smallest overlap.
class DepthSearch {
 public:
  DepthSearch(const Triangle& a, const Triangle& b) : a_(a), b_(b) {}

  /// `scale2` is the squared size that the axis would have if its factors were at right angles.
  void offer(const Vec3& axis, double scale2) {
    const double squared = axis.squaredNorm();
    constexpr double parallel = 1e-22;  // sine below 1e-11: no direction left, only rounding
    if (!(squared > parallel * scale2)) return;
    const Vec3 unit = axis / std::sqrt(squared);
    const Range a = range_along(unit, a_), b = range_along(unit, b_);
    const double forward = b.high - a.low, backward = a.high - b.low;
    const double overlap = std::min(forward, backward);
    if (overlap < best_.depth) best_ = {overlap, forward < backward ? unit : Vec3(-unit)};
  }
  const PairDepth& best() const { return best_; }

 private:
  const Triangle& a_;
  const Triangle& b_;
  PairDepth best_{infinity, Vec3::UnitZ()};
};

}  // namespace

ClosestPoints closest_points(const Triangle& a, const Triangle& b) {
  const Face face_a(a), face_b(b);
  Vec3 point;
  if (pierces(a, b, face_b, point) || pierces(b, a, face_a, point)) return {0, point, point};
  Best best;
  std::array<Vec3, 3> v;
  std::array<double, 3> vv{};
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = b[(k + 1) % 3] - b[k];
    vv[k] = v[k].squaredNorm();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 u = a[(i + 1) % 3] - a[i];
    const double uu = u.squaredNorm();
    for (std::size_t k = 0; k < 3; ++k) offer_edges(a[i], u, uu, b[k], v[k], vv[k], best);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (foot_in_face(a[i], b, face_b, point)) best.offer(a[i], point);
    if (foot_in_face(b[i], a, face_a, point)) best.offer(point, b[i]);
  }
  return best.points;
}

double gap_along(const Vec3& unit, const Triangle& a, const Triangle& b) {
  const Range x = range_along(unit, a), y = range_along(unit, b);
  return std::max(y.low - x.high, x.low - y.high);
}

double squared_distance(const Vec3& p, const Triangle& t) {
  const Face face(t);
  Vec3 foot;
  if (foot_in_face(p, t, face, foot)) return (p - foot).squaredNorm();
  double best = infinity;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d = t[(i + 1) % 3] - t[i];
    best = std::min(best, (t[i] + nearest_parameter(t[i], d, p) * d - p).squaredNorm());
  }
  return best;
}

PairDepth pair_depth(const Triangle& a, const Triangle& b, double enough_apart) {
  DepthSearch search(a, b);
  const auto apart = [&] { return search.best().depth < -enough_apart; };
  std::array<Vec3, 3> u, v;
  std::array<double, 3> uu{}, vv{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = a[(i + 1) % 3] - a[i];
    v[i] = b[(i + 1) % 3] - b[i];
    uu[i] = u[i].squaredNorm();
    vv[i] = v[i].squaredNorm();
  }
  const Vec3 n = u[0].cross(u[1]), m = v[0].cross(v[1]);
  const double nn = n.squaredNorm(), mm = m.squaredNorm();
  search.offer(n, uu[0] * uu[1]);
  search.offer(m, vv[0] * vv[1]);
  if (apart()) return search.best();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      search.offer(u[i].cross(v[k]), uu[i] * vv[k]);
      if (apart()) return search.best();
    }
  for (std::size_t i = 0; i < 3; ++i) {
    search.offer(n.cross(u[i]), nn * uu[i]);
    search.offer(m.cross(v[i]), mm * vv[i]);
  }
  return search.best();
}

}  // namespace aircut::collide
