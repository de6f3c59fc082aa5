// collide: proof that two bodies stay apart over an interval of time, or the first contact.
// Distances come from box trees over the triangles; docs/collide.md says how and what is proven:
//
//   d(t) a lower bound of the distance at t, μ(t, Δ) a bound of the relative motion within Δ of t:
//   d(t) > μ(t, Δ) + margin   ⇒   clear over [t − Δ, t + Δ]
//
// Units mm, s.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::collide {

/// A mesh prepared for queries: box tree, shells for the containment test. Immutable,
/// thread-safe, shared between bodies with the same mesh.
class CollisionMesh {
 public:
  explicit CollisionMesh(const TriangleMesh& mesh);
  ~CollisionMesh();
  CollisionMesh(CollisionMesh&&) noexcept;

  const Box3& box() const;     ///< in mesh coordinates
  const Vec3& centre() const;  ///< of a sphere that holds the mesh
  double radius() const;
  /// Shells that are not closed take no part in the containment test.
  bool all_closed() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

struct Distance {
  double value = 0;     ///< mm; 0 when surfaces intersect or one body is inside the other
  Vec3 on_a, on_b;      ///< closest points (contact point when 0), in the frame of the poses
  bool capped = false;  ///< nothing is nearer than the bound; the points mean nothing
};
/// Distance of two placed meshes; looked for up to `bound` (capped beyond). Containment counts as
/// 0.
Distance distance(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b,
                  const Pose& X_WB, double bound);
/// True when surfaces intersect or one is inside the other.
bool overlap(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b, const Pose& X_WB);

/// Depth of an overlap: the smallest shift along one of several directions that separates the two
/// (directions: contact normals, axes, `preferred`), refined to `tolerance`; an upper bound of the
/// true penetration depth. Zero when there is no overlap.
struct Penetration {
  double depth = 0;
  Vec3 direction = Vec3::UnitZ();  ///< shift of A that separates, unit vector
  Vec3 point = Vec3::Zero();       ///< a contact point, mm
};
Penetration penetration(const CollisionMesh& a, const Pose& X_WA, const CollisionMesh& b,
                        const Pose& X_WB, const std::vector<Vec3>& preferred, double tolerance);

/// Motion of B seen from A over time.
struct RelativeMotion {
  /// Pose of B's mesh frame seen from A's at time t; nothing when the pose does not exist.
  std::function<std::optional<Pose>(double t)> X_AB;
  /// Bound of how far any point of B moves relative to A within [ta, tb]; nothing when unknown.
  std::function<std::optional<double>(double ta, double tb)> travel;
};

/// Proven: the distance stays at or above `distance` (≤ the margin asked for) over the interval.
struct Clear {
  double distance = 0;
};
/// The interiors overlap.
struct Hit {
  double t_first = 0;         ///< first contact, early by at most the resolution
  double t_overlap = 0;       ///< a time at which the overlap is certain
  Vec3 point = Vec3::Zero();  ///< contact point in A's frame at t_overlap
};
/// Neither could be proven: the bodies come within the resolution of touching in [t0, t1].
struct Unresolved {
  double t0 = 0, t1 = 0;
  double distance_low = 0, distance_high = 0;
};
/// Nearer than the margin somewhere, but proven not to touch.
struct Near {
  double t = 0;  ///< time of the smallest distance found
  double distance_low = 0, distance_high = 0;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< closest points in A's frame at t
};
using Outcome = std::variant<Clear, Near, Hit, Unresolved>;

struct ProofOptions {
  double margin = 0;          ///< near-miss distance, mm; 0 = only contact matters
  double resolution = 0.005;  ///< ε_r, mm
  double touch = 0.001;       ///< ε_c, contact tolerance, mm
  /// Wanted width of a near miss's interval of distance, mm; 0 = the resolution.
  double near_width = 0;
};

struct ProofCost {
  std::uint64_t distance_queries = 0;
  std::uint64_t overlap_queries = 0;
};

/// Clearance left over from the last proof of the same pair: the distance was at least `distance`
/// and the bodies have moved by at most `used` since. Lets long runs of distant motion pass without
/// a query.
struct Budget {
  double distance = -1;  ///< negative: nothing known
};

/// Proof over [t0, t1].
Outcome prove(const CollisionMesh& a, const CollisionMesh& b, const RelativeMotion& motion,
              double t0, double t1, const ProofOptions& options, Budget& budget, ProofCost& cost);

}  // namespace aircut::collide
