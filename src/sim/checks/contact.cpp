#include "sim/checks/contact.h"

namespace aircut::sim {

using machine::LinkPoses;

Pose mesh_pose(const machine::Body& body, const LinkPoses& poses) {
  return poses.X_WL[static_cast<std::size_t>(index(body.link))] * body.X_LB;
}

collide::RelativeMotion relative_motion(const machine::MotionBound& bound, const SceneBody& a,
                                        const SceneBody& b, PoseCache& cache) {
  return {
      .X_AB = [&a, &b, &cache](double t) -> std::optional<Pose> {
        const LinkPoses* poses = cache.at(t);
        if (!poses) return std::nullopt;
        return mesh_pose(a.body, *poses).inverse(Eigen::Isometry) * mesh_pose(b.body, *poses);
      },
      .travel = [&bound, &a, &b, &cache](double ta, double tb) -> std::optional<double> {
        const std::vector<double>* travel = cache.travel(ta, tb);
        const LinkPoses* poses = travel ? cache.at(0.5 * (ta + tb)) : nullptr;
        if (!poses) return std::nullopt;
        return bound.bound(a.body.link, mesh_pose(a.body, *poses) * a.collision->centre(),
                           a.collision->radius(), b.body.link,
                           mesh_pose(b.body, *poses) * b.collision->centre(), b.collision->radius(),
                           *poses, *travel);
      },
  };
}

bool PairAt::overlap(double t) {
  const LinkPoses* poses = cache_.at(t);
  ++cost_.overlap_queries;
  return poses && collide::overlap(*a_.collision, mesh_pose(a_.body, *poses), *b_.collision,
                                   mesh_pose(b_.body, *poses));
}

double PairAt::distance(double t, double bound) {
  const LinkPoses* poses = cache_.at(t);
  ++cost_.distance_queries;
  if (!poses) return 0;
  return collide::distance(*a_.collision, mesh_pose(a_.body, *poses), *b_.collision,
                           mesh_pose(b_.body, *poses), bound)
      .value;
}

double PairAt::end_of_contact(const collide::Hit& hit, double t1) {
  constexpr int steps = 64;
  double inside = hit.t_overlap;
  for (int i = 1; i <= steps; ++i) {
    const double t = hit.t_overlap + (t1 - hit.t_overlap) * i / steps;
    if (overlap(t)) {
      inside = t;
      continue;
    }
    double outside = t;
    while (outside - inside > 1e-6) {
      const double middle = 0.5 * (inside + outside);
      if (!(inside < middle && middle < outside)) break;
      (overlap(middle) ? inside : outside) = middle;
    }
    return outside;
  }
  return t1;
}

double PairAt::end_of_touch(double t, double t1, double resolution) {
  constexpr int steps = 256;
  for (int i = 1; i <= steps; ++i) {
    const double at = t + (t1 - t) * i / steps;
    if (distance(at, 3 * resolution) > 2 * resolution) return at;
  }
  return t1;
}

std::optional<PairAt::Worst> PairAt::deepest(double t0, double t1, double tolerance) {
  constexpr int samples = 8;
  std::optional<Worst> worst;
  for (int i = 0; i <= samples; ++i) {
    const double t = t0 + (t1 - t0) * i / samples;
    const LinkPoses* poses = cache_.at(t);
    if (!poses) continue;
    const Pose X_WA = mesh_pose(a_.body, *poses), X_WB = mesh_pose(b_.body, *poses);
    const auto found = collide::penetration(*a_.collision, X_WA, *b_.collision, X_WB,
                                            {X_WA.linear().col(2)}, tolerance);
    if (found.depth > (worst ? worst->penetration.depth : 0)) worst = Worst{t, found};
  }
  return worst;
}

std::optional<double> PairAt::axial_retract(double t) {
  const LinkPoses* poses = cache_.at(t);
  if (!poses) return std::nullopt;
  const Pose X_WA = mesh_pose(a_.body, *poses), X_WB = mesh_pose(b_.body, *poses);
  const Vec3 axis = X_WA.linear().col(2);
  const auto hits_at = [&](double lift) {
    ++cost_.overlap_queries;
    return collide::overlap(*a_.collision, translation(lift * axis) * X_WA, *b_.collision, X_WB);
  };
  constexpr double farthest = 400, step = 2;  // mm
  double low = 0, high = step;
  while (hits_at(high)) {
    low = high;
    high += step;
    if (high > farthest) return std::nullopt;
  }
  while (high - low > 0.005) {
    const double middle = 0.5 * (low + high);
    (hits_at(middle) ? low : high) = middle;
  }
  return high;
}

}  // namespace aircut::sim
