// Private: from moves to pieces whose geometry is final: what happens at each corner.
#pragma once

#include "plan/chain.h"

namespace aircut::plan {

/// A moving command with the modal state that it was given in.
struct Move {
  Segment segment;  ///< command, kind, path, offsets, feed …; no profile yet
  Metric metric = Metric::none;
  double feed = 0;  ///< limit of the tip's speed along the metric; infinity for a rapid
  canon::PathMode mode = canon::PathMode::continuous;
  double tolerance = 0;  ///< G64 P; 0 = no limit
};

class Shaper {
 public:
  Shaper(const machine::Machine& machine, machine::JointVector start, double period,
         std::size_t max_nodes);

  void push(Move move);
  /// A segment without way that the motion does not wait for.
  void push_still(Segment segment);
  /// The motion ends at rest here.
  void stop();
  std::optional<Segment> take() { return chain_.take(); }

  /// After a failure nothing comes in any more.
  bool failed() const { return failed_; }
  const machine::JointVector& joints() const { return joints_; }

 private:
  enum class Corner { stop, pass };
  Corner corner_of(const Move& left, const Move& right) const;
  void finish_pending();
  void add(Move move, bool stop_before);
  void fail(Segment segment, const Failure& failure, bool stop_before);
  void append(Segment segment, Grid grid, bool stop_before);

  const machine::Machine& machine_;
  JointLimits limits_;
  double period_;
  Chain chain_;
  std::optional<Move> pending_;       ///< its end is not final
  bool pending_stops_before_ = true;  ///< rest at its start
  std::vector<Segment> after_;        ///< stand-still segments behind the pending move
  machine::JointVector joints_;       ///< at the end of what went into the chain
  machine::JointVector dq_end_;       ///< q' at the end of the last piece
  AxisValues d_end_;                  ///< tip's derivative there
  bool failed_ = false;
  std::vector<double> scratch_;
};

}  // namespace aircut::plan
