// FCL answers "do these surfaces intersect", with OBBRSS trees in double. Its other two answers are
// not used: continuousCollide reports cubes that pass through one another as free, and distance()
// is too large for some pairs of triangles in nearly parallel planes (docs/collide.md), which a
// proof of clearance can't accept; distances come from box_tree.cpp.
#include "collide/fcl_tree.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <vector>

namespace aircut::collide {

struct FclTree::Model {
  fcl::BVHModel<fcl::OBBRSSd> bvh;
};

FclTree::FclTree(const TriangleMesh& mesh) {
  auto model = std::make_unique<Model>();
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->bvh.beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->bvh.addSubModel(mesh.vertices, triangles);
  model->bvh.endModel();
  model_ = std::move(model);
}

FclTree::~FclTree() = default;

bool surfaces_meet(const FclTree& a, const FclTree& b, const Pose& X_AB) {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(&a.model_->bvh, fcl::Transform3d::Identity(), &b.model_->bvh, X_AB, request, result);
  return result.isCollision();
}

}  // namespace aircut::collide
