// Depth of an overlap by trying directions.
//
// For a direction u the shift s that separates is looked for upwards: tolerance, twice that, and so
// on, then between the last shift that overlaps and the first that doesn't by halving. Any shift
// that separates is an upper bound of the depth; the smallest over the directions is the answer.
// Directions are the axes, the lines of the centres, the wishes of the caller, and for some of the
// intersecting triangles their faces and the axis that separates the two.
#include <algorithm>
#include <cmath>

#include "collide/mesh_impl.h"

namespace aircut::collide {
namespace {

/// Intersecting triangles whose directions are tried; contacts of smooth bodies are much alike.
constexpr std::size_t max_contacts = 64;
constexpr std::size_t max_directions = 32;

struct Contacts {
  std::vector<Vec3> directions;
  Vec3 point = Vec3::Zero();
  bool any = false;
};

void add_direction(std::vector<Vec3>& list, const Vec3& direction) {
  const double length = direction.norm();
  if (!(length > 1e-12) || list.size() >= max_directions) return;
  const Vec3 unit = direction / length;
  const auto same = [&](const Vec3& other) { return (other - unit).squaredNorm() < 1e-4; };
  if (std::none_of(list.begin(), list.end(), same)) list.push_back(unit);
}

/// In A's frame.
Contacts contacts_of(const CollisionMesh& a, const CollisionMesh& b, const Pose& X_AB) {
  Contacts out;
  std::size_t count = 0;
  double deepest = -1;
  for_near_pairs(TreePair(*a.impl().tree, *b.impl().tree, X_AB), 0,
                 [&](const Triangle& ta, const Triangle& tb) {
                   const PairDepth pair = pair_depth(ta, tb, 0);
                   if (pair.depth < 0) return true;
                   out.any = true;
                   if (pair.depth > deepest) {
                     deepest = pair.depth;
                     out.point = closest_points(ta, tb).on_a;
                   }
                   add_direction(out.directions, pair.axis);
                   add_direction(out.directions, (tb[1] - tb[0]).cross(tb[2] - tb[0]));
                   add_direction(out.directions, -(ta[1] - ta[0]).cross(ta[2] - ta[0]));
                   return ++count < max_contacts;
                 });
  return out;
}

}  // namespace

Penetration penetration(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b,
                        const Pose& X_WB, const std::vector<Vec3>& preferred, double tolerance) {
  Penetration best;
  if (!overlap(a, X_WA, b, X_WB)) return best;
  const Pose X_AB = X_WA.inverse() * X_WB;
  const Contacts contacts = contacts_of(a, b, X_AB);
  const std::optional<Vec3> inner = contacts.any ? std::nullopt : contained_point(a, b, X_AB);
  best.point = X_WA * (inner ? *inner : contacts.point);

  std::vector<Vec3> directions;
  for (const Vec3& u : preferred) add_direction(directions, u);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) add_direction(directions, sign * Vec3::Unit(axis));
  add_direction(directions, X_WA * a.centre() - X_WB * b.centre());
  for (const Vec3& u : contacts.directions) add_direction(directions, X_WA.linear() * u);

  const double step = std::max(tolerance, 1e-9);
  const auto overlaps_at = [&](const Vec3& u, double s) {
    return overlap(a, translation(s * u) * X_WA, b, X_WB);
  };
  // No shift beyond this leaves the balls around the bodies in contact.
  best.depth = (X_WA * a.centre() - X_WB * b.centre()).norm() + a.radius() + b.radius();
  for (const Vec3& u : directions) {
    double low = 0, high = step;
    while (high < best.depth && overlaps_at(u, high)) {
      low = high;
      high *= 2;
    }
    if (high >= best.depth) {
      // Only a shift below the best one is of interest.
      high = best.depth - step;
      if (high <= low || overlaps_at(u, high)) continue;
    }
    while (high - low > step) {
      const double middle = 0.5 * (low + high);
      (overlaps_at(u, middle) ? low : high) = middle;
    }
    best.depth = high;
    best.direction = u;
  }
  return best;
}

}  // namespace aircut::collide
