// Private: from moves to pieces whose geometry is final: what happens at each corner.
#pragma once

#include "plan/blend.h"
#include "plan/chain.h"
#include "plan/corner_load.h"
#include "plan/reach.h"
#include "plan/s_curve.h"

namespace aircut::plan {

/// A line that a chord replaces: its share of the chord, and what stands behind it.
struct Part {
  canon::Command command;
  double end = 0;  ///< s on the chord
  std::vector<Segment> after;
};

/// A moving command with the modal state that it was given in.
struct Move {
  Segment segment;  ///< command, kind, path, offsets, feed …; no profile yet
  Metric metric = Metric::none;
  double feed = 0;  ///< limit of the tip's speed along the metric; infinity for a rapid
  canon::PathMode mode = canon::PathMode::continuous;
  double tolerance = 0;     ///< G64 P, mm; 0 = no limit
  double merge = 0;         ///< G64 Q, mm; 0 = off
  std::vector<Part> parts;  ///< of a merged chord; empty for a single command
};

class Shaper {
 public:
  Shaper(const machine::Machine& machine, machine::JointVector start, const Options& options);

  void push(Move move);
  /// A segment without way that the motion does not wait for.
  void push_still(Segment segment);
  /// The motion ends at rest here.
  void stop();
  std::optional<Segment> take() { return chain_.take(); }

  /// What the joints allow along a straight way that starts where the motion rests.
  struct StraightRun {
    StraightLimits limits{};
    machine::JointVector end;  ///< joints there
  };
  /// Nothing where the way can't be gone to its end.
  std::optional<StraightRun> straight_run(const Line& line, const AxisValues& tool_offset);
  /// A segment from rest to rest that has its time law; `end`: the joints behind it.
  void push_planned(Segment segment, const machine::JointVector& end);
  /// Revolutions of the spindle; after stop() those at the end of everything.
  double spindle_turns() const { return chain_.spindle_turns(); }
  Statistics statistics() const { return chain_.statistics(); }

  /// What follows is in this kinematics, which must outlive the shaper; the motion rests.
  void switch_to(const machine::Kinematics& kinematics);

  /// At the end of everything, once the motion rests.
  const machine::JointVector& joints() const { return joints_; }
  /// After a failure nothing comes in any more.
  bool failed() const { return failed_; }

 private:
  struct Rest {};  ///< the corner is a stop
  struct Pass {};  ///< both sides are tangent
  using Corner = std::variant<Rest, Pass, CornerBlend>;

  Corner corner_to(const Move& right) const;
  double jerk_entry(double scale) const;
  std::optional<CornerDirections> line_directions(const AxisValues& in, const AxisValues& out,
                                                  const CornerShape& corner,
                                                  const AxisValues& tool_offset) const;
  std::optional<KnownRates> known_rates(const Move& left, const Move& right,
                                        const CornerBlend& corner) const;
  double turning(const CornerDirections& to) const;
  CornerLoad line_load(const AxisValues& in, const AxisValues& out,
                       const CornerDirections& directions, const CornerRates& rates, double cut,
                       double feed) const;
  void finish_pending();
  void add_blend(const Move& left, const Move& right, const CornerBlend& corner);
  void add_range(Move& move, double begin, double end);
  void add(Segment&& segment, Metric metric, double feed, Follows follows, bool passes,
           const KnownRates* known = nullptr);
  void append(Segment&& segment);

  const machine::Kinematics* kinematics_;
  JointLimits limits_;
  double period_;
  Chain chain_;
  std::optional<Move> pending_;            ///< its end is not final
  double begin_ = 0, end_ = 0;             ///< what is left of the pending move, along its s
  std::vector<Segment> after_;             ///< stand-still segments behind the pending move
  bool linear_joints_;                     ///< in the tip, so that no joint bends on a line
  bool at_rest_ = true;                    ///< the next piece starts from rest
  machine::JointVector joints_;            ///< at the end of what went into the chain
  machine::JointVector dq_end_, ddq_end_;  ///< q' and q'' at the end of the last piece
  AxisValues d_end_;                       ///< tip's derivative there
  bool failed_ = false;
  std::vector<double> scratch_;
  ProvenBox proven_;
  MadeGrid made_;  ///< of the piece that is being added
};

}  // namespace aircut::plan
