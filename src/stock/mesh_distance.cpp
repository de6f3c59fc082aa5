// A tree of boxes over the triangles, split at the middle of the longest side of their centres.
//
// The nearest triangle is looked for in the nearer box first; boxes beyond the best distance so far
// are left out. Inside or outside: the triangles that a half-line from the point crosses, each
// counted +1 where it leaves the solid and −1 where it enters. The sum is above 0 inside, also
// where closed shells overlap. A half-line that passes so near to an edge that rounding decides
// which triangle it crosses is given up, and one in another direction is taken.
#include "stock/mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aircut::stock {
namespace {

constexpr std::uint32_t leaf = 4;  // triangles
constexpr double edge = 1e-9;      // barycentric: nearer to an edge rounding decides

double squared_distance(const Box3& box, const Vec3& p) {
  return (box.min() - p).cwiseMax(p - box.max()).cwiseMax(0).squaredNorm();
}

/// Does the half-line from p along `way` meet the box?
bool meets(const Box3& box, const Vec3& p, const Vec3& way) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    double t0 = (box.min()[a] - p[a]) / way[a], t1 = (box.max()[a] - p[a]) / way[a];
    if (t0 > t1) std::swap(t0, t1);
    // Wider by rounding, so that nothing on the box's faces is lost.
    const double slack = 1e-9 * (1 + std::abs(t0) + std::abs(t1));
    from = std::max(from, t0 - slack);
    to = std::min(to, t1 + slack);
  }
  return from <= to;
}

}  // namespace

MeshDistance::MeshDistance(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {
  const auto count = static_cast<std::uint32_t>(mesh_->triangles.size());
  std::vector<Vec3> centres;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto& t = mesh_->triangles[i];
    centres.push_back((mesh_->vertices[t[0]] + mesh_->vertices[t[1]] + mesh_->vertices[t[2]]) / 3);
    order_.push_back(i);
  }
  nodes_.emplace_back();
  build(0, 0, count, centres);
}

void MeshDistance::build(std::size_t node, std::uint32_t first, std::uint32_t count,
                         const std::vector<Vec3>& centres) {
  Box3 box, middle;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const std::uint32_t v : mesh_->triangles[order_[i]]) box.extend(mesh_->vertices[v]);
    middle.extend(centres[order_[i]]);
  }
  nodes_[node].box = box;
  if (count <= leaf) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  int axis = 0;
  middle.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(centres[a][axis], a) < std::pair(centres[b][axis], b);
  });
  const std::size_t children = nodes_.size();
  nodes_[node].first = static_cast<std::uint32_t>(children);
  nodes_.resize(children + 2);
  build(children, first, half, centres);
  build(children + 1, first + half, count - half, centres);
}

// The nearest point of a triangle: of its plane when that lies over it, else of its nearest side.
double MeshDistance::to_triangle(const Vec3& p, std::uint32_t triangle) const {
  const auto& t = mesh_->triangles[triangle];
  const std::array<Vec3, 3> v = {mesh_->vertices[t[0]], mesh_->vertices[t[1]],
                                 mesh_->vertices[t[2]]};
  const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
  bool over = n.squaredNorm() > 0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = v[i], side = v[(i + 1) % 3] - a, to = p - a;
    if (n.dot(side.cross(to)) >= 0) continue;  // this side has the point on its inner hand
    over = false;
    const double length = side.squaredNorm();
    const double s = length > 0 ? std::clamp(to.dot(side) / length, 0.0, 1.0) : 0;
    best = std::min(best, (to - s * side).squaredNorm());
  }
  if (over) {
    const double height = n.dot(p - v[0]);
    return height * height / n.squaredNorm();
  }
  if (n.squaredNorm() > 0) return best;
  for (const Vec3& a : v) best = std::min(best, (p - a).squaredNorm());
  return best;
}

double MeshDistance::distance(const Vec3& p, double bound) const {
  // A little more than the bound, so that rounding can't lose the triangle that gave it.
  double best = bound * bound * (1 + 1e-9) + 1e-18;
  double found = std::numeric_limits<double>::infinity();
  std::array<std::pair<std::uint32_t, double>, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, squared_distance(nodes_[0].box, p)};
  while (depth > 0) {
    const auto [at, near] = stack[--depth];
    if (near > best) continue;
    const Node& node = nodes_[at];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        found = std::min(found, to_triangle(p, order_[i]));
      best = std::min(best, found);
      continue;
    }
    const double a = squared_distance(nodes_[node.first].box, p);
    const double b = squared_distance(nodes_[node.first + 1].box, p);
    const bool first = a <= b;
    if (std::max(a, b) <= best) stack[depth++] = {node.first + (first ? 1 : 0), std::max(a, b)};
    if (std::min(a, b) <= best) stack[depth++] = {node.first + (first ? 0 : 1), std::min(a, b)};
  }
  return std::sqrt(found);
}

bool MeshDistance::winding(const Vec3& p, const Vec3& way, int& out) const {
  out = 0;
  std::array<std::uint32_t, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!meets(node.box, p, way)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& t = mesh_->triangles[order_[i]];
      const Vec3 &a = mesh_->vertices[t[0]], ab = mesh_->vertices[t[1]] - a,
                 ac = mesh_->vertices[t[2]] - a;
      const Vec3 across = way.cross(ac);
      const double det = ab.dot(across);                             // −n · way
      if (std::abs(det) <= 1e-14 * ab.norm() * ac.norm()) continue;  // seen from its side
      const Vec3 to = p - a;
      const double u = to.dot(across) / det;
      const Vec3 q = to.cross(ab);
      const double v = way.dot(q) / det, w = ac.dot(q) / det;
      if (u < -edge || v < -edge || u + v > 1 + edge || w < 0) continue;
      if (u < edge || v < edge || u + v > 1 - edge) return false;
      out += det < 0 ? 1 : -1;
    }
  }
  return true;
}

bool MeshDistance::inside(const Vec3& p) const {
  if (!nodes_[0].box.contains(p)) return false;
  // Directions that no plane of a drawing has.
  static const std::array<Vec3, 4> ways = {
      Vec3(0.5377, 0.2911, 0.7913), Vec3(-0.3313, 0.8731, 0.3571), Vec3(0.7159, -0.6007, -0.3557),
      Vec3(-0.4637, -0.2179, 0.8587)};
  int turns = 0;
  for (const Vec3& way : ways)
    if (winding(p, way, turns)) break;
  return turns > 0;
}

double MeshDistance::outside(const Vec3& p, double bound) const {
  const double d = distance(p, bound);
  return inside(p) ? -d : d;
}

}  // namespace aircut::stock
