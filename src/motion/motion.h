// motion: the joints over time, q(t), of a segment on a machine, with proven bounds on how far each
// joint travels in an interval. Units mm, rad, s.
#pragma once

#include <optional>
#include <span>
#include <string>
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

class JointMotion;

/// One of the motions that a machine is moved by at once.
struct PartMotion {
  const JointMotion* motion = nullptr;
  std::vector<int> joints;  ///< of the whole machine, for each of its own; -1: it leaves that alone
};

class JointMotion {
 public:
  /// Borrows machine and segment for its life. `near` are the joints at the segment's start, for
  /// the choice of branch.
  JointMotion(const machine::Machine& machine, const plan::Segment& segment, JointVector near);

  /// The motion of a machine whose channels move at once: every part moves its joints, the others
  /// stand as in `rest`. All parts last as long as the segment of `lead`, whose tip and way are
  /// told. Borrows everything.
  JointMotion(const machine::Machine& whole, const JointMotion& lead, std::vector<PartMotion> parts,
              JointVector rest);

  double t0() const;  ///< program time of the start, s
  double t1() const;
  const plan::Segment& segment() const { return *segment_; }
  const machine::Machine& machine() const { return *machine_; }

  /// Joints at program time t in [t0, t1].
  tl::expected<JointVector, machine::ReachError> at(double t) const;
  /// Joints `s` mm along the segment's path.
  tl::expected<JointVector, machine::ReachError> at_path(double s) const;
  /// Joints, speeds, accelerations.
  tl::expected<JointState, machine::ReachError> state_at(double t) const;
  AxisValues tip_at(double t) const;
  /// Where the machine's own kinematics has a commanded tip of this segment, which may be in those
  /// of another kinematics: for what is drawn on the work.
  AxisValues tip_on_work(const JointVector& joints, const AxisValues& tip) const;
  /// Upper bound of the way of every driven joint, then of every passive value, in [ta, tb];
  /// false when no finite bound is known. `travel` has travel_count() elements or more.
  bool travel_bound(double ta, double tb, std::span<double> travel) const;

 private:
  const machine::Machine* machine_;
  const machine::Kinematics* kinematics_;
  const plan::Segment* segment_;
  JointVector near_at(double s) const;
  tl::expected<JointState, machine::ReachError> whole_state_at(double t) const;
  bool whole_bound(double ta, double tb, std::span<double> travel) const;
  /// travel_bound() of a kinematics that is solved numerically.
  bool numeric_bound(double s0, double s1, machine::TipInterval& tip,
                     std::span<double> travel) const;

  /// Joints at even steps along the path, each found from the one before: on long moves the joints
  /// at the start say nothing about the turn or branch at the end.
  std::vector<JointVector> anchors_;
  // Of a whole machine:
  const JointMotion* lead_ = nullptr;  ///< null: this is one channel's motion
  std::vector<PartMotion> parts_;
  JointVector rest_;
};

/// How many values travel_bound() gives: driven joints and passive values.
std::size_t travel_count(const machine::Machine& machine);

/// Signed joint value over time within one motion: value(t) = sign · q_joint(t). Borrows the
/// motion.
class JointTrack {
 public:
  JointTrack(const JointMotion& motion, machine::JointId joint, double sign);
  /// Nothing where the machine can't reach.
  std::optional<double> value(double t) const;
  /// Upper bound of the joint's way in [ta, tb]; nothing when no bound is known.
  std::optional<double> travel(double ta, double tb);

 private:
  const JointMotion& motion_;
  int joint_;
  double sign_;
  std::vector<double> travel_;
};

struct Extreme {
  double t = 0;
  double value = 0;  ///< of a JointTrack
};

/// Largest value over [ta, tb] to `accuracy`, if it is above that of `best`, which it replaces;
/// false when it can't be known.
bool search_maximum(JointTrack& track, double ta, double tb, double accuracy, Extreme& best);
/// Earliest time in [ta, tb] with a value above `limit` (to a nanosecond), if there is one.
std::optional<double> first_above(JointTrack& track, double ta, double tb, double limit);

/// How a joint that passes its limit is told.
struct LimitText {
  std::string message, remedy;
};
/// `worst` = sign · q; sign +1 for the upper limit, −1 for the lower one.
LimitText text_of_passed_limit(const machine::Joint& joint, double sign, double worst);

}  // namespace aircut::motion
