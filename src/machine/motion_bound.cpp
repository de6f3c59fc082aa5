// How far a body moves, seen from another body.
//
// Let the couples between the links of A and B be 1 (next to A) … n (next to B), and x a point of
// A. In the frame of the link behind couple k, x is displaced between two moments by at most
//
//   D_k = D_{k−1} + (sliding: travel_k;  rotary: min(travel_k · ρ_k, 2 ρ_k)),      D_0 = 0,
//
// since |E(q')x' − E(q)x| ≤ |x' − x| + |E(q')x − E(q)x|: first what the couples before k did, then
// the turn of one fixed point, an arc about the axis or, at most, its diameter. ρ_k is the distance
// of x from axis k at the moment that the turn is applied to. Seen from the links at couple k its
// axis stands still, and x is at most D_{k−1} away from where it is at the moment of `poses`:
// ρ_k ≤ (distance of the ball's centre from the axis in `poses`) + radius + D_{k−1}.
// D_n bounds the displacement of every point of A seen from B. (verification.md §3.)
#include <algorithm>
#include <cassert>

#include "machine/machine.h"

namespace aircut::machine {

namespace {
constexpr std::size_t never_moves = static_cast<std::size_t>(-1);  // couple of another channel
}

struct MotionBound::Ball {
  Vec3 centre;  // world
  double radius;
};

MotionBound::MotionBound(const Machine& machine) : machine_(&machine) {
  const std::vector<std::string> passive = machine.kinematics().passive_names();
  for (const Joint& joint : machine.tree()) {
    std::size_t slot = 0;
    if (joint.driven >= 0) {
      slot = static_cast<std::size_t>(joint.driven);
    } else if (joint.held) {
      slot = never_moves;
    } else {
      const auto found = std::find(passive.begin(), passive.end(), joint.passive);
      assert(found != passive.end() && "the kinematics has a value for every passive couple");
      slot = static_cast<std::size_t>(machine.joint_count() + (found - passive.begin()));
    }
    travel_index_.push_back(slot);
  }
  depth_.assign(machine.links().size(), 0);
  for (const Joint& joint : machine.tree())  // parents come before children
    depth_[static_cast<std::size_t>(index(joint.child))] =
        depth_[static_cast<std::size_t>(index(joint.parent))] + 1;
}

LinkId MotionBound::common(LinkId a, LinkId b) const {
  const auto depth = [&](LinkId link) { return depth_[static_cast<std::size_t>(index(link))]; };
  const auto parent = [&](LinkId link) {
    return machine_->links()[static_cast<std::size_t>(index(link))].parent;
  };
  while (a != b) (depth(a) >= depth(b) ? a : b) = parent(depth(a) >= depth(b) ? a : b);
  return a;
}

double MotionBound::over(int couple, double moved, const Ball& ball, const LinkPoses& poses,
                         std::span<const double> travel) const {
  const auto at = static_cast<std::size_t>(couple);
  const Joint& joint = machine_->tree()[at];
  if (travel_index_[at] == never_moves) return moved;
  const double way = travel[travel_index_[at]];
  if (joint.kind == JointKind::linear) return moved + way;
  const Pose& X_WL = poses.X_WL[static_cast<std::size_t>(index(joint.parent))];
  const Vec3 from_axis = ball.centre - X_WL * joint.origin;
  const double distance = (X_WL.linear() * joint.direction).cross(from_axis).norm();
  const double rho = distance + ball.radius + moved;
  return moved + std::min(way * rho, 2 * rho);
}

double MotionBound::up(LinkId from, LinkId to, const Ball& ball, const LinkPoses& poses,
                       std::span<const double> travel) const {
  double moved = 0;
  while (from != to) {
    const Link& link = machine_->links()[static_cast<std::size_t>(index(from))];
    moved = over(link.joint, moved, ball, poses, travel);
    from = link.parent;
  }
  return moved;
}

double MotionBound::down(LinkId from, LinkId to, double moved, const Ball& ball,
                         const LinkPoses& poses, std::span<const double> travel) const {
  if (from == to) return moved;
  const Link& link = machine_->links()[static_cast<std::size_t>(index(to))];
  return over(link.joint, down(from, link.parent, moved, ball, poses, travel), ball, poses, travel);
}

double MotionBound::bound(LinkId a, const Vec3& centre_a, double radius_a, LinkId b,
                          const Vec3& centre_b, double radius_b, const LinkPoses& poses,
                          std::span<const double> travel) const {
  const LinkId meet = common(a, b);
  const Ball ball_a{centre_a, radius_a};
  const Ball ball_b{centre_b, radius_b};
  const double a_from_b = down(meet, b, up(a, meet, ball_a, poses, travel), ball_a, poses, travel);
  const double b_from_a = down(meet, a, up(b, meet, ball_b, poses, travel), ball_b, poses, travel);
  return std::min(a_from_b, b_from_a);
}

}  // namespace aircut::machine
