// FCL's OBBRSS tree of a mesh and its overlap test. Private; FCL is included in fcl_tree.cpp only.
#pragma once

#include <memory>

#include "geometry/geometry.h"

namespace aircut::collide {

/// Immutable, thread-safe.
class FclTree {
 public:
  /// Precondition: the mesh has triangles.
  explicit FclTree(const TriangleMesh& mesh);
  ~FclTree();
  FclTree(const FclTree&) = delete;
  FclTree& operator=(const FclTree&) = delete;

 private:
  friend bool surfaces_meet(const FclTree& a, const FclTree& b, const Pose& X_AB);
  struct Model;
  std::unique_ptr<const Model> model_;
};

/// Do any two triangles intersect? Containment is not seen here.
bool surfaces_meet(const FclTree& a, const FclTree& b, const Pose& X_AB);

}  // namespace aircut::collide
