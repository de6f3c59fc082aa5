// Private: the cuts of several channels as those of one machine.
#pragma once

#include <vector>

#include "sim/cuts.h"

namespace aircut::sim {

/// Gives cuts on with their channel, the joints of the whole machine, and places and directions in
/// its frame M. Those of an interval wait until it is over: then they come in the order of time. A
/// pause shorter than a revolution of the spindle, as between the intervals, is none
/// (accuracy.md, simultaneous tools): the cut after it begins where the one before has ended.
class ChannelCuts final : public CutListener {
 public:
  ChannelCuts(CutListener& to, const machine::Machine& whole) : to_(to), whole_(whole) {}

  /// What comes next is `channel`'s, in its own view of the machine, whose joints are these of the
  /// whole one; all joints there are as in `now`.
  void come_from(std::size_t channel, const machine::Machine& view, const std::vector<int>& joints,
                 const JointVector& now);
  void on_cut(const Cut& cut) override;
  /// The interval is over.
  void hand_over();

 private:
  void bridge(Cut& cut);

  CutListener& to_;
  const machine::Machine& whole_;
  std::size_t channel_ = 0;
  Pose X_MC_ = Pose::Identity();  ///< the view's frame M, seen from the whole machine's
  std::vector<int> joints_;
  JointVector now_;
  std::vector<Cut> waiting_;
  std::vector<double> ends_;  ///< of each channel's last cut, s
  double last_begin_ = 0;     ///< of what was given on, s
};

}  // namespace aircut::sim
