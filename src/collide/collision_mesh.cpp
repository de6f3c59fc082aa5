// Meshes prepared for queries; distance, overlap and containment of two placed meshes.
//
// Surfaces that don't meet leave three cases: apart, A in B, B in A. One corner of each closed
// shell of either body then tells them apart, since a whole shell is on one side of the other's
// surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "collide/collide.h"
#include "collide/mesh_impl.h"

namespace aircut::collide {
namespace {

/// Looks for a point far from the surface by going inwards from the largest triangles.
std::optional<Vec3> deep_point(const BoxTree& tree, const TriangleMesh& mesh, const Shell& shell) {
  constexpr std::size_t candidates = 6;
  std::vector<std::pair<double, std::uint32_t>> by_area;
  for (const std::uint32_t i : shell.triangles) {
    const auto& t = mesh.triangles[i];
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    by_area.emplace_back(-n.squaredNorm(), i);
  }
  const std::size_t count = std::min(candidates, by_area.size());
  std::partial_sort(by_area.begin(), by_area.begin() + static_cast<std::ptrdiff_t>(count),
                    by_area.end());
  std::optional<Vec3> best;
  double best_chord = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& t = mesh.triangles[by_area[k].second];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 inwards = -(b - a).cross(c - a).normalized();
    const Vec3 start = 0.36 * a + 0.33 * b + 0.31 * c;  // no point of symmetry
    const auto chord = tree.first_hit(start, inwards, 1e-9 * (b - a).norm());
    if (!chord || *chord <= best_chord) continue;
    const Vec3 middle = start + 0.5 * *chord * inwards;
    if (!tree.inside(middle)) continue;
    best = middle;
    best_chord = *chord;
  }
  return best;
}

}  // namespace

CollisionMesh::Impl::Impl(const TriangleMesh& source) {
  mesh_ = welded(source);
  const TriangleMesh& mesh = mesh_;
  if (mesh.empty()) return;
  box = bounds(mesh);
  centre = box.center();
  radius = radius_about(mesh, centre);
  const std::vector<Shell> parts = shells(mesh);
  std::vector<char> solid(mesh.triangles.size(), 0);
  for (const Shell& shell : parts) {
    all_closed = all_closed && shell.closed;
    if (!shell.closed) continue;
    for (const std::uint32_t i : shell.triangles) solid[i] = 1;
    shell_points.push_back(mesh.vertices[mesh.triangles[shell.triangles.front()][0]]);
  }
  tree.emplace(mesh, solid);
  for (const Shell& shell : parts)
    if (shell.closed)
      if (const auto point = deep_point(*tree, mesh, shell)) deep_points.push_back(*point);
}

const FclTree& CollisionMesh::Impl::fcl() const {
  std::call_once(fcl_once_, [this] { fcl_ = std::make_unique<FclTree>(mesh_); });
  return *fcl_;
}

CollisionMesh::CollisionMesh(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
CollisionMesh::~CollisionMesh() = default;
CollisionMesh::CollisionMesh(CollisionMesh&&) noexcept = default;

const Box3& CollisionMesh::box() const { return impl_->box; }
const Vec3& CollisionMesh::centre() const { return impl_->centre; }
double CollisionMesh::radius() const { return impl_->radius; }
bool CollisionMesh::all_closed() const { return impl_->all_closed; }

double box_distance(const CollisionMesh& a, const CollisionMesh& b, const Pose& X_AB) {
  if (!a.impl().tree || !b.impl().tree) return std::numeric_limits<double>::infinity();
  const double spheres = (X_AB * b.centre() - a.centre()).norm() - a.radius() - b.radius();
  const TreePair pair(*a.impl().tree, *b.impl().tree, X_AB);
  const double boxes = std::sqrt(pair.box_gap(pair.a.node(0).box, pair.b.node(0).box));
  return std::max(spheres, boxes);
}

std::optional<Nearest> surface_distance(const CollisionMesh& a, const CollisionMesh& b,
                                        const Pose& X_AB, double bound,
                                        const Tolerance& tolerance) {
  if (!a.impl().tree || !b.impl().tree) return std::nullopt;
  return nearest(TreePair(*a.impl().tree, *b.impl().tree, X_AB), bound, tolerance);
}

std::optional<Vec3> contained_point(const CollisionMesh& a, const CollisionMesh& b,
                                    const Pose& X_AB) {
  if (!a.impl().tree || !b.impl().tree) return std::nullopt;
  for (const Vec3& p : b.impl().shell_points)
    if (a.impl().tree->inside(X_AB * p)) return X_AB * p;
  const Pose X_BA = X_AB.inverse();
  for (const Vec3& p : a.impl().shell_points)
    if (b.impl().tree->inside(X_BA * p)) return p;
  return std::nullopt;
}

Distance distance(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b,
                  const Pose& X_WB, double bound) {
  const Pose X_AB = X_WA.inverse() * X_WB;
  Distance out{.value = bound, .on_a = Vec3::Zero(), .on_b = Vec3::Zero(), .capped = true};
  if (const auto found = surface_distance(a, b, X_AB, bound))
    out = Distance{std::sqrt(found->points.squared), X_WA * found->points.on_a,
                   X_WA * found->points.on_b, false};
  if (out.value > 0)
    if (const auto inner = contained_point(a, b, X_AB))
      out = Distance{0, X_WA * *inner, X_WA * *inner, false};
  return out;
}

bool overlap(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b, const Pose& X_WB) {
  if (!a.impl().tree || !b.impl().tree) return false;
  const Pose X_AB = X_WA.inverse() * X_WB;
  return surfaces_meet(a.impl().fcl(), b.impl().fcl(), X_AB) ||
         contained_point(a, b, X_AB).has_value();
}

}  // namespace aircut::collide
