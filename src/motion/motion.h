// motion: the joints over time, q(t), of a segment on a machine, with proven bounds on how far each
// joint travels in an interval. Units mm, rad, s.
#pragma once

#include <span>
#include <vector>

#include "machine/machine.h"
#include "plan/plan.h"

namespace aircut::motion {

using machine::JointVector;

/// Joints with their analytic time derivatives.
struct JointState {
  JointVector q, v, a;
  AxisValues tip;         ///< commanded tip, machine coordinates
  double path_speed = 0;  ///< along the feed metric, mm/s
  double s = 0;           ///< along the segment's path, mm
};

class JointMotion {
 public:
  /// Borrows machine and segment for its life. `near` are the joints at the segment's start, for
  /// the choice of branch.
  JointMotion(const machine::Machine& machine, const plan::Segment& segment, JointVector near);

  double t0() const;  ///< program time of the start, s
  double t1() const;
  const plan::Segment& segment() const { return *segment_; }
  const machine::Machine& machine() const { return *machine_; }

  /// Joints at program time t in [t0, t1].
  tl::expected<JointVector, machine::ReachError> at(double t) const;
  /// Joints, speeds, accelerations.
  tl::expected<JointState, machine::ReachError> state_at(double t) const;
  AxisValues tip_at(double t) const;
  /// Upper bound of the way of every driven joint, then of every passive value, in [ta, tb];
  /// false when no finite bound is known. `travel` has machine.tree().size() elements.
  bool travel_bound(double ta, double tb, std::span<double> travel) const;

 private:
  const machine::Machine* machine_;
  const plan::Segment* segment_;
  JointVector near_at(double s) const;

  /// Joints at even steps along the path, each found from the one before: on long moves the joints
  /// at the start say nothing about the turn or branch at the end.
  std::vector<JointVector> anchors_;
};

}  // namespace aircut::motion
