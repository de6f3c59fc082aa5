// The joints of a segment over time: s(t) by the profile, the tip by the path, the joints by the
// machine's inverse kinematics, each time anew: nothing is interpolated.
//
//   q̇ = q' ṡ        q̈ = q' s̈ + q'' ṡ²        (' = d/ds)
//
// Travel: s only grows, so in [ta, tb] the tip stays on the path between s(ta) and s(tb); the
// path's box and way there go to the kinematics, which bounds every joint over them.
//
// A numeric solution could jump to another branch between two places, though each is a solution.
// Its bound counts only if both ends of the interval lie in the branch that it was proven for:
// intervals share their ends, so the joints of the whole segment are then one branch.
#include "motion/motion.h"

#include <algorithm>
#include <cmath>

namespace aircut::motion {

using machine::ReachError;
using machine::Target;

namespace {
constexpr int steps = 8;  // of the anchors: 45° of a full turn
}  // namespace

JointMotion::JointMotion(const machine::Machine& machine, const plan::Segment& segment,
                         JointVector near)
    : machine_(&machine),
      kinematics_(&plan::kinematics_of(segment, machine.kinematics())),
      segment_(&segment) {
  anchors_.push_back(std::move(near));
  const double length = plan::length(segment.path);
  if (!(length > 0) || std::holds_alternative<plan::JointWay>(segment.path)) return;
  anchors_.reserve(steps + 1);
  for (int i = 1; i <= steps; ++i) {
    const AxisValues tip = plan::evaluate(segment.path, length * i / steps).p;
    auto q = kinematics_->inverse(Target{tip, segment.tool_offset}, anchors_.back());
    // The planner made sure that this can't be; at() will tell, should it be so.
    anchors_.push_back(q ? std::move(*q) : anchors_.back());
  }
}

JointVector JointMotion::near_at(double s) const {
  if (anchors_.size() == 1) return anchors_.front();
  const double step = std::floor(s / plan::length(segment_->path) * steps);
  return anchors_[static_cast<std::size_t>(std::clamp(step, 0.0, double{steps}))];
}

JointMotion::JointMotion(const machine::Machine& whole, const JointMotion& lead,
                         std::vector<PartMotion> parts, JointVector rest)
    : machine_(&whole),
      kinematics_(&whole.kinematics()),
      segment_(lead.segment_),
      lead_(&lead),
      parts_(std::move(parts)),
      rest_(std::move(rest)) {}

double JointMotion::t0() const { return segment_->t_start; }
double JointMotion::t1() const { return segment_->t_end(); }

tl::expected<JointVector, ReachError> JointMotion::at(double t) const {
  if (lead_) {
    JointVector q = rest_;
    for (const PartMotion& part : parts_) {
      const auto own = part.motion->at(t);
      if (!own) return own;
      for (std::size_t j = 0; j < part.joints.size(); ++j)
        if (part.joints[j] >= 0) q[part.joints[j]] = (*own)[static_cast<Eigen::Index>(j)];
    }
    return q;
  }
  return at_path(segment_->profile.at(t - segment_->t_start).s);
}

tl::expected<JointVector, ReachError> JointMotion::at_path(double s) const {
  if (lead_) {
    double low = 0, high = segment_->duration();
    for (int i = 0; i < 50 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      (segment_->profile.at(middle).s < s ? low : high) = middle;
    }
    return at(segment_->t_start + high);
  }
  if (const auto* way = std::get_if<plan::JointWay>(&segment_->path))
    return plan::joint_point(*way, s).q;
  const AxisValues tip = plan::evaluate(segment_->path, s).p;
  return kinematics_->inverse(Target{tip, segment_->tool_offset}, near_at(s));
}

AxisValues JointMotion::tip_at(double t) const {
  const double s = segment_->profile.at(t - segment_->t_start).s;
  return plan::evaluate(segment_->path, s).p;
}

AxisValues JointMotion::tip_on_work(const JointVector& joints, const AxisValues& tip) const {
  if (!segment_->kinematics) return tip;
  return machine_->kinematics().forward(joints, segment_->tool_offset).value_or(tip);
}

tl::expected<JointState, ReachError> JointMotion::state_at(double t) const {
  if (lead_) return whole_state_at(t);
  const auto [s, v, a] = segment_->profile.at(t - segment_->t_start);
  const plan::PathPoint p = plan::evaluate(segment_->path, s);
  const Target target{p.p, segment_->tool_offset};
  JointState out;
  out.tip = p.p;
  out.s = s;
  if (const auto* way = std::get_if<plan::JointWay>(&segment_->path)) {
    plan::JointPoint joint = plan::joint_point(*way, s);
    out.q = std::move(joint.q);
    out.v = v * joint.dq;
    out.a = a * joint.dq + v * v * joint.ddq;
    out.path_speed = v * plan::metric_speed(segment_->path, p);
    return out;
  }
  if (v == 0 && a == 0) {
    auto q = kinematics_->inverse(target, near_at(s));
    if (!q) return unexpected(q.error());
    out.q = std::move(*q);
    out.v = out.a = JointVector::Zero(out.q.size());
    return out;
  }
  auto joint = plan::joint_point(*kinematics_, target, p.d, p.dd, near_at(s));
  if (!joint) return unexpected(joint.error());
  out.q = std::move(joint->q);
  out.v = v * joint->dq;
  out.a = a * joint->dq + v * v * joint->ddq;
  out.path_speed = v * plan::metric_speed(segment_->path, p);
  return out;
}

tl::expected<JointState, ReachError> JointMotion::whole_state_at(double t) const {
  auto out = lead_->state_at(t);
  if (!out) return out;
  out->q = rest_;
  out->v = out->a = JointVector::Zero(rest_.size());
  for (const PartMotion& part : parts_) {
    const auto own = part.motion->state_at(t);
    if (!own) return own;
    for (std::size_t j = 0; j < part.joints.size(); ++j) {
      if (part.joints[j] < 0) continue;
      const auto i = static_cast<Eigen::Index>(j);
      out->q[part.joints[j]] = own->q[i];
      out->v[part.joints[j]] = own->v[i];
      out->a[part.joints[j]] = own->a[i];
    }
  }
  return out;
}

bool JointMotion::whole_bound(double ta, double tb, std::span<double> travel) const {
  std::fill(travel.begin(), travel.end(), 0.0);
  std::vector<double> own;
  for (const PartMotion& part : parts_) {
    own.assign(part.motion->machine().tree().size(), 0);
    if (!part.motion->travel_bound(ta, tb, own)) return false;
    for (std::size_t j = 0; j < part.joints.size(); ++j)
      if (part.joints[j] >= 0) travel[static_cast<std::size_t>(part.joints[j])] = own[j];
  }
  return true;
}

bool JointMotion::travel_bound(double ta, double tb, std::span<double> travel) const {
  if (lead_) return whole_bound(ta, tb, travel);
  const auto [s0, s1] = segment_->profile.range(ta - segment_->t_start, tb - segment_->t_start);
  if (!(s1 > s0)) {
    std::fill(travel.begin(), travel.end(), 0.0);
    return true;
  }
  if (const auto* way = std::get_if<plan::JointWay>(&segment_->path)) {
    // No joint turns back; rounding of its values is far below a millionth of them.
    const JointVector q0 = plan::joint_point(*way, s0).q, q1 = plan::joint_point(*way, s1).q;
    for (Eigen::Index j = 0; j < q0.size(); ++j)
      travel[static_cast<std::size_t>(j)] = std::abs(q1[j] - q0[j]) + 1e-12 * std::abs(q1[j]);
    return true;
  }
  machine::TipInterval tip = plan::bounds(segment_->path, s0, s1);
  tip.tool_offset = segment_->tool_offset;
  if (kinematics_->type() == "serial") return numeric_bound(s0, s1, tip, travel);
  tip.near = near_at(s0);
  return kinematics_->travel_bound(tip, travel);
}

bool JointMotion::numeric_bound(double s0, double s1, machine::TipInterval& tip,
                                std::span<double> travel) const {
  const auto q0 = at_path(s0), q1 = at_path(s1);
  if (!q0 || !q1) return false;
  tip.near = *q0;
  if (!kinematics_->travel_bound(tip, travel)) return false;
  for (Eigen::Index j = 0; j < q0->size(); ++j)
    if (!(std::abs((*q1)[j] - (*q0)[j]) <= travel[static_cast<std::size_t>(j)])) return false;
  return true;
}

}  // namespace aircut::motion
