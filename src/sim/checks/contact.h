// Private: link poses of one step, and what can be said of a pair that was found in contact.
#pragma once

#include <array>

#include "sim/sim.h"

namespace aircut::sim {

// Link poses at times of one step, worked out once however many pairs ask.
class PoseCache {
 public:
  PoseCache(const machine::Machine& machine, const motion::JointMotion& motion)
      : machine_(machine), motion_(motion) {}

  const machine::LinkPoses* at(double t) {
    for (Entry& entry : entries_)
      if (entry.filled && entry.t == t) return entry.reachable ? &entry.poses : nullptr;
    Entry& entry = entries_[next_++ % entries_.size()];
    entry.filled = true;
    entry.t = t;
    const auto q = motion_.at(t);
    entry.reachable = q.has_value();
    if (q) machine::forward(machine_, *q, entry.poses);
    return entry.reachable ? &entry.poses : nullptr;
  }

  // Travel of every couple within [ta, tb]; null when no bound is known.
  const std::vector<double>* travel(double ta, double tb) {
    if (!(known_ && ta == ta_ && tb == tb_)) {
      travel_.assign(machine_.tree().size(), 0);
      bounded_ = motion_.travel_bound(ta, tb, travel_);
      known_ = true;
      ta_ = ta;
      tb_ = tb;
    }
    return bounded_ ? &travel_ : nullptr;
  }

 private:
  struct Entry {
    bool filled = false, reachable = false;
    double t = 0;
    machine::LinkPoses poses;
  };
  const machine::Machine& machine_;
  const motion::JointMotion& motion_;
  std::array<Entry, 32> entries_;
  std::size_t next_ = 0;
  bool known_ = false, bounded_ = false;
  double ta_ = 0, tb_ = 0;
  std::vector<double> travel_;
};

/// Pose of a body's mesh in the world.
Pose mesh_pose(const machine::Body& body, const machine::LinkPoses& poses);

/// Motion of b seen from a over a step. Borrows everything.
collide::RelativeMotion relative_motion(const machine::MotionBound& bound, const SceneBody& a,
                                        const SceneBody& b, PoseCache& cache);

/// A pair of bodies at times of one step. Borrows everything.
class PairAt {
 public:
  PairAt(const SceneBody& a, const SceneBody& b, PoseCache& cache, collide::ProofCost& cost)
      : a_(a), b_(b), cache_(cache), cost_(cost) {}

  bool overlap(double t);
  /// Distance at time t, looked for up to `bound`; 0 for a pose that doesn't exist.
  double distance(double t, double bound);
  /// When the bodies come apart after hit.t_overlap, found by stepping and halving; t1 if they
  /// don't.
  double end_of_contact(const collide::Hit& hit, double t1);
  /// When bodies that part are clearly apart, after time t; t1 if they aren't until then.
  double end_of_touch(double t, double t1, double resolution);

  struct Worst {
    double t = 0;
    collide::Penetration penetration;
  };
  /// The deepest of several times between t0 and t1.
  std::optional<Worst> deepest(double t0, double t1, double tolerance);
  /// How far A has to move along its own Z (the tool axis) to clear B at time t, mm.
  std::optional<double> axial_retract(double t);

 private:
  const SceneBody& a_;
  const SceneBody& b_;
  PoseCache& cache_;
  collide::ProofCost& cost_;
};

}  // namespace aircut::sim
