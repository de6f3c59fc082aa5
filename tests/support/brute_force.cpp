// The distance of two triangles is found as the minimum over edge pairs (by alternately projecting
// from one edge to the other, which converges since the problem is convex) and corners against
// faces (barycentric coordinates from the normal equations). Intersection is decided by clipping
// one triangle's edges against the other's plane and three sides.
#include "support/brute_force.h"

#include <array>
#include <cmath>
#include <numbers>

namespace aircut::brute_force {
namespace {

using Corners = std::array<Vec3, 3>;

std::vector<Corners> placed(const TriangleMesh& mesh, const Pose& X) {
  std::vector<Corners> out;
  for (const auto& t : mesh.triangles)
    out.push_back({X * mesh.vertices[t[0]], X * mesh.vertices[t[1]], X * mesh.vertices[t[2]]});
  return out;
}

Vec3 nearest_on_edge(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 d = b - a;
  const double t = d.dot(p - a) / d.dot(d);
  if (t <= 0) return a;
  if (t >= 1) return b;
  return a + t * d;
}

/// Minimum over one edge of the distance to the other one: a convex function of the place, found by
/// golden section.
double edge_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto at = [&](double s) {
    const Vec3 p = a + s * (b - a);
    return (p - nearest_on_edge(c, d, p)).norm();
  };
  constexpr double ratio = 0.6180339887498949;
  double low = 0, high = 1;
  double x = high - ratio * (high - low), y = low + ratio * (high - low);
  double fx = at(x), fy = at(y);
  for (int i = 0; i < 60; ++i) {
    if (fx < fy) {
      high = y;
      y = x;
      fy = fx;
      x = high - ratio * (high - low);
      fx = at(x);
    } else {
      low = x;
      x = y;
      fx = fy;
      y = low + ratio * (high - low);
      fy = at(y);
    }
  }
  return std::min({fx, fy, at(0), at(1)});
}

/// Barycentric coordinates of p's foot in the triangle's plane.
Vec3 barycentric(const Corners& t, const Vec3& p) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
  const double det = uu * vv - uv * uv;
  const double s = (vv * wu - uv * wv) / det, r = (uu * wv - uv * wu) / det;
  return {1 - s - r, s, r};
}

double corner_to_face(const Vec3& p, const Corners& t) {
  const Vec3 c = barycentric(t, p);
  if (c.minCoeff() < 0) return HUGE_VAL;
  return (c[0] * t[0] + c[1] * t[1] + c[2] * t[2] - p).norm();
}

bool edge_meets(const Vec3& p, const Vec3& q, const Corners& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double x = n.dot(p - t[0]), y = n.dot(q - t[0]);
  if ((x > 0 && y > 0) || (x < 0 && y < 0) || x == y) return false;
  return barycentric(t, p + (q - p) * (x / (x - y))).minCoeff() >= 0;
}

bool meet(const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 3; ++i)
    if (edge_meets(a[i], a[(i + 1) % 3], b) || edge_meets(b[i], b[(i + 1) % 3], a)) return true;
  return false;
}

double distance(const Corners& a, const Corners& b) {
  if (meet(a, b)) return 0;
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::min({best, corner_to_face(a[i], b), corner_to_face(b[i], a)});
    for (std::size_t k = 0; k < 3; ++k)
      best = std::min(best, edge_distance(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
  }
  return best;
}

/// Lower bound of the distance by balls about the triangles.
double apart_at_least(const Corners& a, const Corners& b) {
  const auto centre = [](const Corners& t) -> Vec3 { return (t[0] + t[1] + t[2]) / 3; };
  const auto radius = [&](const Corners& t) {
    double r = 0;
    for (const Vec3& p : t) r = std::max(r, (p - centre(t)).norm());
    return r;
  };
  return (centre(a) - centre(b)).norm() - radius(a) - radius(b);
}

double point_to_surface(const Vec3& p, const std::vector<Corners>& surface) {
  double best = HUGE_VAL;
  for (const Corners& t : surface) {
    best = std::min(best, corner_to_face(p, t));
    for (std::size_t i = 0; i < 3; ++i)
      best = std::min(best, (nearest_on_edge(t[i], t[(i + 1) % 3], p) - p).norm());
  }
  return best;
}

bool inside(const std::vector<Corners>& surface, const Vec3& p) {
  double sum = 0;
  for (const Corners& t : surface) {
    const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return std::abs(sum) > std::numbers::pi;  // 2π inside, 0 outside
}

bool any_corner_inside(const std::vector<Corners>& of, const std::vector<Corners>& in) {
  for (const Corners& t : of)
    for (const Vec3& p : t)
      if (inside(in, p)) return true;
  return false;
}

}  // namespace

double surface_distance(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                        const Pose& X_WB) {
  const auto ta = placed(a, X_WA), tb = placed(b, X_WB);
  double best = HUGE_VAL;
  for (const Corners& x : ta)
    for (const Corners& y : tb)
      if (apart_at_least(x, y) < best) best = std::min(best, distance(x, y));
  return best;
}

bool surfaces_meet(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                   const Pose& X_WB) {
  const auto ta = placed(a, X_WA), tb = placed(b, X_WB);
  for (const Corners& x : ta)
    for (const Corners& y : tb)
      if (meet(x, y)) return true;
  return false;
}

bool inside(const TriangleMesh& mesh, const Vec3& p) {
  return inside(placed(mesh, Pose::Identity()), p);
}

bool overlap(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB) {
  if (surfaces_meet(a, X_WA, b, X_WB)) return true;
  const auto ta = placed(a, X_WA), tb = placed(b, X_WB);
  return any_corner_inside(ta, tb) || any_corner_inside(tb, ta);
}

double corner_depth(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                    const Pose& X_WB) {
  const auto ta = placed(a, X_WA), tb = placed(b, X_WB);
  double depth = 0;
  const auto look = [&](const std::vector<Corners>& of, const std::vector<Corners>& in) {
    for (const Corners& t : of)
      for (const Vec3& p : t)
        if (inside(in, p)) depth = std::max(depth, point_to_surface(p, in));
  };
  look(ta, tb);
  look(tb, ta);
  return depth;
}

Sampled sample_motion(const TriangleMesh& a, const TriangleMesh& b,
                      const std::function<Pose(double)>& X_AB, double t0, double t1, double speed,
                      double step) {
  Sampled out;
  out.smallest = HUGE_VAL;
  for (double t = t0;;) {
    const Pose X = X_AB(t);
    const bool meets = overlap(a, Pose::Identity(), b, X);
    const double d = meets ? 0 : surface_distance(a, Pose::Identity(), b, X);
    ++out.samples;
    if (d < out.smallest) {
      out.smallest = d;
      out.t_smallest = t;
    }
    if (meets) out.first_overlap = t;
    if (meets || t >= t1) return out;
    t = std::min(t1, t + std::max(step, d) / speed);
  }
}

}  // namespace aircut::brute_force
