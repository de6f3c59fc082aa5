// What a CollisionMesh holds, and queries on placed meshes in the frame of A. Private to the
// collide library.
#pragma once

#include <mutex>
#include <vector>

#include "collide/box_tree.h"
#include "collide/collide.h"
#include "collide/fcl_tree.h"

namespace aircut::collide {

struct CollisionMesh::Impl {
  explicit Impl(const TriangleMesh& mesh);

  std::optional<BoxTree> tree;  ///< nothing for a mesh without triangles
  /// FCL's tree, built when an overlap is first asked for: most bodies never come that near.
  const FclTree& fcl() const;
  Box3 box;
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  bool all_closed = true;
  /// A corner of each closed shell: where shells and surfaces don't meet, it stands for its shell.
  std::vector<Vec3> shell_points;
  /// A point well inside the material for each closed shell that has one.
  std::vector<Vec3> deep_points;

 private:
  TriangleMesh mesh_;
  mutable std::once_flag fcl_once_;
  mutable std::unique_ptr<const FclTree> fcl_;
};

/// Lower bound of the distance from boxes and spheres alone, mm.
double box_distance(const CollisionMesh& a, const CollisionMesh& b, const Pose& X_AB);

/// Surfaces only; nothing when none is nearer than `bound`.
std::optional<Nearest> surface_distance(const CollisionMesh& a, const CollisionMesh& b,
                                        const Pose& X_AB, double bound,
                                        const Tolerance& tolerance = {});

/// A corner (A's frame) of a shell of one body that is inside the other; its surfaces must be
/// apart.
std::optional<Vec3> contained_point(const CollisionMesh& a, const CollisionMesh& b,
                                    const Pose& X_AB);

/// A point (A's frame) that proves an overlap deeper than `touch`: no shift of `touch` or less can
/// separate the bodies. Nothing when no proof was found.
std::optional<Vec3> certain_overlap(const CollisionMesh& a, const CollisionMesh& b,
                                    const Pose& X_AB, double touch);

}  // namespace aircut::collide
