// Trees of axis-parallel boxes, each in its mesh's frame.
//
// Built top down: the triangles of a node are split at the median of their centres along the
// longest side of the box of the centres (ties by number, so that the tree is the same every time).
// Two trees are compared without refitting: a box of B seen from A is bounded by the absolute
// rotation matrix, and the gap of the two boxes is the larger of the gaps seen in A's axes and in
// B's axes.
//
// Inside: a ray from the point leaves the closed shells more often than it enters them. Counting
// with signs lets shells overlap (screws in a plate) and cavities be empty. A ray that passes too
// close to an edge, a corner or along a face is not trusted; the next direction is tried, and when
// all are used up, the solid angles of the triangles are summed instead.
#include "collide/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aircut::collide {
namespace {

constexpr std::uint32_t leaf_size = 2;

CentredBox centred(const Box3& box) {
  CentredBox out{box.center(), 0.5 * box.sizes()};
  // Rounding of centre and half must not let a corner out.
  out.half += Vec3::Constant(4e-16 * (out.centre.cwiseAbs() + out.half).maxCoeff());
  return out;
}

/// Whether the ray meets the box; direction's components may be 0.
bool ray_meets(const CentredBox& box, const Vec3& origin, const Vec3& inverse) {
  double low = 0, high = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double half = box.half[i] * (1 + 1e-12) + 1e-12;
    const double x = (box.centre[i] - half - origin[i]) * inverse[i];
    const double y = (box.centre[i] + half - origin[i]) * inverse[i];
    low = std::max(low, std::min(x, y));
    high = std::min(high, std::max(x, y));
  }
  return low <= high;
}

enum class RayHit { misses, leaves, enters, unclear };

/// Ray against triangle; `t` is the distance in units of `direction`.
RayHit ray_triangle(const Vec3& origin, const Vec3& direction, const Triangle& triangle,
                    double& t) {
  constexpr double margin = 1e-9;  // of the triangle's size: nearer to an edge is not trusted
  const Vec3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Vec3 n = u.cross(v), w = origin - triangle[0];
  const double facing = -n.dot(direction);
  const double scale = n.norm() * direction.norm();
  if (std::abs(facing) <= margin * scale) {
    // Along the face: only a triangle in the ray's own plane can matter.
    const double size = std::max(u.norm(), v.norm());
    return std::abs(n.dot(w)) > 1e-6 * n.norm() * (size + w.norm()) ? RayHit::misses
                                                                    : RayHit::unclear;
  }
  const Vec3 e = w.cross(direction);
  const double a = v.dot(e) / facing, b = -u.dot(e) / facing;
  t = n.dot(w) / facing;
  if (a < -margin || b < -margin || a + b > 1 + margin) return RayHit::misses;
  if (a < margin || b < margin || a + b > 1 - margin) return RayHit::unclear;
  return facing > 0 ? RayHit::enters : RayHit::leaves;
}

}  // namespace

BoxTree::BoxTree(const TriangleMesh& mesh, const std::vector<char>& solid) {
  std::vector<Triangle> source;
  source.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    source.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  const auto n = static_cast<std::uint32_t>(source.size());
  std::vector<std::uint32_t> order(n);
  for (std::uint32_t i = 0; i < n; ++i) order[i] = i;
  nodes_.reserve(n);
  build(source, order, 0, n);
  triangles_.reserve(n);
  for (const std::uint32_t i : order) {
    const Triangle& t = source[i];
    triangles_.push_back(t);
    normals_.push_back((t[1] - t[0]).cross(t[2] - t[0]).normalized());
    solid_.push_back(solid[i]);
  }
}

std::uint32_t BoxTree::build(const std::vector<Triangle>& source, std::vector<std::uint32_t>& order,
                             std::uint32_t begin, std::uint32_t end) {
  Box3 box, centres;
  const auto centre_of = [&](std::uint32_t i) -> Vec3 {
    return source[i][0] + source[i][1] + source[i][2];  // three times the centre
  };
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vec3& p : source[order[i]]) box.extend(p);
    centres.extend(centre_of(order[i]));
  }
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({.box = centred(box)});
  if (end - begin <= leaf_size) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return self;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                   [&](std::uint32_t i, std::uint32_t k) {
                     const double x = centre_of(i)[axis], y = centre_of(k)[axis];
                     return x != y ? x < y : i < k;
                   });
  build(source, order, begin, middle);
  const std::uint32_t right = build(source, order, middle, end);
  nodes_[self].right = right;
  return self;
}

std::optional<int> BoxTree::crossings(const Vec3& origin, const Vec3& direction) const {
  const Vec3 inverse = direction.cwiseInverse();
  int count = 0;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    const Node& node = nodes_[at];
    if (!ray_meets(node.box, origin, inverse)) continue;
    if (!node.is_leaf()) {
      open.push_back(node.right);
      open.push_back(at + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      double t = 0;
      if (solid_[i] == 0) continue;
      const RayHit hit = ray_triangle(origin, direction, triangles_[i], t);
      if (hit == RayHit::unclear) return std::nullopt;
      if (hit != RayHit::misses && t > 0) count += hit == RayHit::leaves ? 1 : -1;
    }
  }
  return count;
}

double BoxTree::winding(const Vec3& p) const {
  // Solid angle of a triangle by Van Oosterom and Strackee (1983).
  double sum = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (solid_[i] == 0) continue;
    const Vec3 a = triangles_[i][0] - p, b = triangles_[i][1] - p, c = triangles_[i][2] - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum +=
        2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return sum / (4 * std::numbers::pi);
}

bool BoxTree::inside(const Vec3& p) const {
  const CentredBox& box = nodes_[0].box;
  if (((p - box.centre).cwiseAbs() - box.half).maxCoeff() > 0) return false;
  // Directions without a relation to axes, diagonals or each other.
  static const std::array<Vec3, 6> directions = {
      Vec3(0.5377, 0.8339, 0.1249),  Vec3(-0.2259, 0.3188, 0.9206),
      Vec3(0.8622, -0.4336, 0.2618), Vec3(-0.3426, -0.6578, 0.6707),
      Vec3(0.1397, 0.5349, -0.8333), Vec3(-0.7254, 0.6299, -0.2774)};
  for (const Vec3& direction : directions)
    if (const auto count = crossings(p, direction)) return *count != 0;
  return std::abs(winding(p)) > 0.5;
}

template <class Visit>
void BoxTree::for_near(const Vec3& p, double reach, Visit&& visit) const {
  const double reach2 = reach * reach;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    const Node& node = nodes_[at];
    const Vec3 gap = ((p - node.box.centre).cwiseAbs() - node.box.half).cwiseMax(0.0);
    if (gap.squaredNorm() > reach2) continue;
    if (!node.is_leaf()) {
      open.push_back(node.right);
      open.push_back(at + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (squared_distance(p, triangles_[i]) <= reach2 && !visit(triangles_[i])) return;
  }
}

bool BoxTree::surface_within(const Vec3& p, double reach) const {
  bool found = false;
  for_near(p, reach, [&](const Triangle&) {
    found = true;
    return false;
  });
  return found;
}

std::vector<Vec3> BoxTree::normals_near(const Vec3& p, double reach) const {
  std::vector<Vec3> out;
  for_near(p, reach, [&](const Triangle& t) {
    out.push_back((t[1] - t[0]).cross(t[2] - t[0]).normalized());
    return true;
  });
  return out;
}

std::optional<double> BoxTree::first_hit(const Vec3& origin, const Vec3& direction,
                                         double from) const {
  const Vec3 inverse = direction.cwiseInverse();
  std::optional<double> first;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    const Node& node = nodes_[at];
    if (!ray_meets(node.box, origin, inverse)) continue;
    if (!node.is_leaf()) {
      open.push_back(node.right);
      open.push_back(at + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      double t = 0;
      if (ray_triangle(origin, direction, triangles_[i], t) == RayHit::misses) continue;
      if (t > from && (!first || t < *first)) first = t;
    }
  }
  return first;
}

namespace {

/// Depth first, the nearer child first, so that the bound shrinks early.
class NearestSearch {
 public:
  NearestSearch(const TreePair& pair, double bound, const Tolerance& tolerance)
      : pair_(pair), tolerance_(tolerance) {
    best_.squared = worth_ = left_out_ = bound * bound;
  }

  std::optional<Nearest> run() {
    const double gap = pair_.box_gap(pair_.a.node(0).box, pair_.b.node(0).box);
    if (gap < worth_) visit(0, 0);
    if (!found_) return std::nullopt;
    return Nearest{best_, std::sqrt(std::min(best_.squared, left_out_))};
  }

 private:
  void visit(std::uint32_t a, std::uint32_t b) {
    const BoxTree::Node &na = pair_.a.node(a), &nb = pair_.b.node(b);
    if (na.is_leaf() && nb.is_leaf()) return compare(na, nb);
    const bool split_a =
        nb.is_leaf() || (!na.is_leaf() && na.box.half.squaredNorm() >= nb.box.half.squaredNorm());
    if (split_a)
      visit_both(a + 1, b, na.right, b);
    else
      visit_both(a, b + 1, a, nb.right);
  }

  void visit_both(std::uint32_t a1, std::uint32_t b1, std::uint32_t a2, std::uint32_t b2) {
    double gap1 = pair_.box_gap(pair_.a.node(a1).box, pair_.b.node(b1).box);
    double gap2 = pair_.box_gap(pair_.a.node(a2).box, pair_.b.node(b2).box);
    if (gap2 < gap1) {
      std::swap(gap1, gap2);
      std::swap(a1, a2);
      std::swap(b1, b2);
    }
    if (gap1 < worth_)
      visit(a1, b1);
    else
      left_out_ = std::min(left_out_, gap1);
    if (gap2 < worth_)
      visit(a2, b2);
    else
      left_out_ = std::min(left_out_, gap2);
  }

  void compare(const BoxTree::Node& na, const BoxTree::Node& nb) {
    for (std::uint32_t k = nb.first; k < nb.first + nb.count; ++k) {
      const Triangle tb = pair_.triangle_b_in_a(k);
      const Vec3 normal_b = pair_.R * pair_.b.unit_normal(k);
      for (std::uint32_t i = na.first; i < na.first + na.count; ++i) {
        const Triangle& ta = pair_.a.triangle(i);
        const double apart =
            std::max({gap_along(pair_.a.unit_normal(i), ta, tb), gap_along(normal_b, ta, tb), 0.0});
        if (apart * apart >= worth_) {
          left_out_ = std::min(left_out_, apart * apart);
          continue;
        }
        const ClosestPoints points = closest_points(ta, tb);
        if (points.squared >= best_.squared) continue;
        lower_to(std::sqrt(points.squared));
        best_ = points;
        found_ = true;
      }
    }
  }

  void lower_to(double distance) {
    best_.squared = distance * distance;
    const double worth =
        std::max(0.0, distance - std::max(tolerance_.relative * distance, tolerance_.absolute));
    worth_ = worth * worth;
  }

  const TreePair& pair_;
  const Tolerance tolerance_;
  ClosestPoints best_;
  double worth_ = 0;     ///< squared; boxes at least this far apart can't improve the best much
  double left_out_ = 0;  ///< squared gap of the nearest boxes that were not looked at
  bool found_ = false;
};

}  // namespace

std::optional<Nearest> nearest(const TreePair& pair, double bound, const Tolerance& tolerance) {
  return NearestSearch(pair, bound, tolerance).run();
}

}  // namespace aircut::collide
