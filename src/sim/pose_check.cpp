#include "sim/pose_check.h"

#include <algorithm>

#include "sim/checks/contact.h"
#include "sim/checks/pairs.h"

namespace aircut::sim {

struct PoseCheck::Impl {
  Scene scene;
  std::vector<Pair> pairs;
  std::vector<std::string> left_out;

  bool touch(const Pair& pair, const machine::LinkPoses& poses) const {
    const SceneBody &a = scene.bodies()[pair.a], &b = scene.bodies()[pair.b];
    const Pose X_WA = mesh_pose(a.body, poses), X_WB = mesh_pose(b.body, poses);
    const double reach = a.collision->radius() + b.collision->radius();
    const Vec3 between = X_WA * a.collision->centre() - X_WB * b.collision->centre();
    return between.squaredNorm() <= reach * reach &&
           collide::overlap(*a.collision, X_WA, *b.collision, X_WB);
  }
};

PoseCheck::PoseCheck(Scene scene, const JointVector& home)
    : impl_(new Impl{std::move(scene), {}, {}}) {
  machine::LinkPoses poses;
  machine::forward(impl_->scene.machine(), home, poses);
  for (Pair& pair : watched_pairs(impl_->scene, {}).pairs) {
    if (!impl_->touch(pair, poses)) {
      impl_->pairs.push_back(std::move(pair));
      continue;
    }
    std::string name = pair.name;
    name.replace(name.find('\n'), 1, " – ");
    impl_->left_out.push_back(std::move(name));
  }
}

PoseCheck::~PoseCheck() = default;

bool PoseCheck::is_free(const JointVector& joints) const {
  thread_local machine::LinkPoses poses;
  machine::forward(impl_->scene.machine(), joints, poses);
  return std::none_of(impl_->pairs.begin(), impl_->pairs.end(),
                      [&](const Pair& pair) { return impl_->touch(pair, poses); });
}

std::size_t PoseCheck::pairs() const { return impl_->pairs.size(); }
const std::vector<std::string>& PoseCheck::left_out() const { return impl_->left_out; }

}  // namespace aircut::sim
