// The distance of two triangles is found as the minimum over edge pairs (of their lines, or of
// their ends; by golden section where they are almost parallel) and corners against faces
// (barycentric coordinates from the normal equations). Intersection is decided by clipping one
// triangle's edges against the other's plane and three sides.
//
// Every pair of triangles counts. A pair, an edge or a whole group of triangles is passed over only
// where a ball about it, or a plane, shows that it is farther away than a distance that was found
// already, so the answer is the same as without.
#include "support/brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

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
double searched_edge_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
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

/// The two lines' distance counts where it is reached inside both edges, else an end is nearest.
/// Edges that run within 0.06° of one direction are searched, since places on them are then
/// known only to more than 1e-10 of their length.
double edge_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double known) {
  const Vec3 u = b - a, v = d - c, w = c - a, n = u.cross(v);
  const double nn = n.squaredNorm();
  if (nn < 1e-6 * u.squaredNorm() * v.squaredNorm()) return searched_edge_distance(a, b, c, d);
  const double apart = std::abs(w.dot(n)) / std::sqrt(nn);
  if (apart >= known) return apart;
  const double s = w.cross(v).dot(n) / nn, r = w.cross(u).dot(n) / nn;
  if (s > 0 && s < 1 && r > 0 && r < 1) return apart;
  return std::min({(nearest_on_edge(c, d, a) - a).norm(), (nearest_on_edge(c, d, b) - b).norm(),
                   (nearest_on_edge(a, b, c) - c).norm(), (nearest_on_edge(a, b, d) - d).norm()});
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

/// Lower bound of the distance of two edges by balls about them.
double edges_apart_at_least(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return 0.5 * ((a + b - c - d).norm() - (b - a).norm() - (d - c).norm());
}

/// Lower bound of the distance: how far one triangle is beyond the other's plane.
double beyond_plane(const Corners& a, const Corners& b) {
  const Vec3 n = (a[1] - a[0]).cross(a[2] - a[0]);
  const double x = n.dot(b[0] - a[0]), y = n.dot(b[1] - a[0]), z = n.dot(b[2] - a[0]);
  return std::max(std::min({x, y, z}), -std::max({x, y, z})) / n.norm();
}

/// The distance, or `known` where it is not smaller.
double distance(const Corners& a, const Corners& b, double known = HUGE_VAL) {
  // 1e-9 mm is far above what rounding can make of a bound.
  const double apart = std::max(beyond_plane(a, b), beyond_plane(b, a)) - 1e-9;
  if (apart >= known) return known;
  if (!(apart > 0) && meet(a, b)) return 0;
  double best = known;
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::min({best, corner_to_face(a[i], b), corner_to_face(b[i], a)});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &p = a[i], &q = a[(i + 1) % 3], &r = b[k], &s = b[(k + 1) % 3];
      if (edges_apart_at_least(p, q, r, s) < best)
        best = std::min(best, edge_distance(p, q, r, s, best));
    }
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

double point_to_triangle(const Vec3& p, const Corners& t) {
  const double to_face = corner_to_face(p, t);
  if (to_face < HUGE_VAL) return to_face;
  double best = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i)
    best = std::min(best, (nearest_on_edge(t[i], t[(i + 1) % 3], p) - p).squaredNorm());
  return std::sqrt(best);
}

double point_to_surface(const Vec3& p, const std::vector<Corners>& surface) {
  double best = HUGE_VAL;
  for (const Corners& t : surface) best = std::min(best, point_to_triangle(p, t));
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
      if (apart_at_least(x, y) < best) best = distance(x, y, best);
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

Solid::Solid(const TriangleMesh& mesh) {
  const TriangleMesh whole = welded(mesh);
  for (const auto& t : whole.triangles)
    triangles_.push_back({whole.vertices[t[0]], whole.vertices[t[1]], whole.vertices[t[2]]});
  for (const Vec3& p : whole.vertices) box_.extend(p);

  // A corner of each connected set of triangles, found by joining the corners of each triangle.
  std::vector<std::size_t> root(whole.vertices.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& t : whole.triangles) {
    root[find(t[1])] = find(t[0]);
    root[find(t[2])] = find(t[0]);
  }
  for (std::size_t i = 0; i < root.size(); ++i)
    if (root[i] == i) shell_corners_.push_back(whole.vertices[i]);
  if (!triangles_.empty()) group(0, triangles_.size());
}

std::size_t Solid::group(std::size_t begin, std::size_t end) {
  Box3 box;
  for (std::size_t i = begin; i < end; ++i)
    for (const Vec3& p : triangles_[i]) box.extend(p);
  Group made{box.center(), 0, begin, end, 0, 0};
  for (std::size_t i = begin; i < end; ++i)
    for (const Vec3& p : triangles_[i])
      made.radius = std::max(made.radius, (p - made.centre).norm());
  const std::size_t at = groups_.size();
  groups_.push_back(made);
  if (end - begin == 1) return at;
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto place = [&](std::size_t i) {
    return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(place(begin), place(middle), place(end), [axis](const auto& x, const auto& y) {
    return x[0][axis] + x[1][axis] + x[2][axis] < y[0][axis] + y[1][axis] + y[2][axis];
  });
  const std::size_t first = group(begin, middle), second = group(middle, end);
  groups_[at].first = first;
  groups_[at].second = second;
  return at;
}

namespace {

Corners moved(const Corners& t, const Pose& X) { return {X * t[0], X * t[1], X * t[2]}; }

}  // namespace

double Solid::to(const Solid& other, const Pose& X, Nearest& nearest) const {
  double best = HUGE_VAL;
  const auto look = [&](std::size_t i, std::size_t k) {
    const double d = distance(triangles_[i], moved(other.triangles_[k], X), best);
    if (d < best) nearest = {i, k};
    best = std::min(best, d);
  };
  look(nearest.here, nearest.there);
  const Pose X_back = X.inverse(Eigen::Isometry);
  // Pairs of groups with a lower bound of their distance; the nearest half of a pair goes on top.
  struct Open {
    std::size_t here, there;
    double bound;
  };
  const auto pair = [&](std::size_t i, std::size_t k) -> Open {
    const Group &a = groups_[i], &b = other.groups_[k];
    return {i, k, (X * b.centre - a.centre).norm() - a.radius - b.radius};
  };
  std::vector<Open> open{pair(0, 0)};
  while (!open.empty() && best > 0) {
    const Open at = open.back();
    open.pop_back();
    // 1e-9 mm is far above what rounding can make of a bound.
    if (at.bound - 1e-9 >= best) continue;
    const Group &a = groups_[at.here], &b = other.groups_[at.there];
    // A single triangle against the ball about the others: large triangles have large balls.
    if (a.first == 0 &&
        point_to_triangle(X * b.centre, triangles_[a.begin]) - b.radius - 1e-9 >= best)
      continue;
    if (b.first == 0 &&
        point_to_triangle(X_back * a.centre, other.triangles_[b.begin]) - a.radius - 1e-9 >= best)
      continue;
    if (a.first == 0 && b.first == 0) {
      look(a.begin, b.begin);
      continue;
    }
    const bool split_here = b.first == 0 || (a.first != 0 && a.radius > b.radius);
    Open x = split_here ? pair(a.first, at.there) : pair(at.here, b.first);
    Open y = split_here ? pair(a.second, at.there) : pair(at.here, b.second);
    if (x.bound < y.bound) std::swap(x, y);
    open.push_back(x);
    open.push_back(y);
  }
  return best;
}

bool Solid::holds(const Vec3& p) const { return box_.contains(p) && inside(triangles_, p); }

double distance(const Solid& a, const Solid& b, const Pose& X_AB, Nearest& nearest) {
  const double surfaces = a.to(b, X_AB, nearest);
  if (surfaces == 0) return 0;
  // No surface is crossed, so all of a shell is inside or all of it is outside.
  for (const Vec3& p : b.shell_corners())
    if (a.holds(X_AB * p)) return 0;
  const Pose X_BA = X_AB.inverse(Eigen::Isometry);
  for (const Vec3& p : a.shell_corners())
    if (b.holds(X_BA * p)) return 0;
  return surfaces;
}

Sampled sample_motion(const Solid& a, const Solid& b, const std::function<Pose(double)>& X_AB,
                      double t0, double t1, double speed, double step) {
  Sampled out;
  out.smallest = HUGE_VAL;
  Nearest nearest;
  for (double t = t0;;) {
    const double d = distance(a, b, X_AB(t), nearest);
    ++out.samples;
    if (d < out.smallest) {
      out.smallest = d;
      out.t_smallest = t;
    }
    if (d == 0) out.first_overlap = t;
    if (d == 0 || t >= t1) return out;
    t = speed > 0 ? std::min(t1, t + std::max(step, d) / speed) : t1;
  }
}

}  // namespace aircut::brute_force
