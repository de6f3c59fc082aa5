// Private: the jerk limit. Pieces come in with their second-order time law and go out with one of
// third order.
#pragma once

#include "plan/jerk_check.h"
#include "plan/speed.h"

namespace aircut::plan {

class JerkStage {
 public:
  /// `start`: joints at program time 0. The kinematics must outlive the stage.
  JerkStage(const machine::Kinematics& kinematics, const JointLimits& limits,
            machine::JointVector start, double period);
  JerkStage& operator=(const JerkStage&) = delete;
  /// A copy, to see what would come out; this one must outlive it.
  JerkStage trial() const { return *this; }

  /// A piece with its fastest second-order profile. `scale`: path speed here per path speed at the
  /// end of the piece before.
  void push(Segment segment, Grid grid, double scale);
  /// A segment without way, or with a time law of its own from rest to rest; it comes out behind
  /// the piece before it.
  void push_still(Segment segment);
  /// The last piece ends at rest.
  void stop();
  /// Program time at the end of all that came in; of what is not final without its jerk limit.
  double time_given() const { return clock_ + waiting_; }
  /// Program time at the end of all that went out.
  double clock() const { return clock_; }
  /// From the highest speed to rest, and from none to the largest acceleration, at most, s.
  double brake_time() const { return window_.brake_time; }
  double ramp_time() const { return ramp_time_; }
  /// Segments whose time law is final, in order.
  std::vector<Segment> take();
  /// Windows that were planned, and steps of the solver for all of them.
  std::uint64_t windows() const { return windows_; }
  std::uint64_t newton_steps() const { return newton_steps_; }

 private:
  JerkStage(const JerkStage&) = default;
  double way_end() const { return items_.back().end(); }
  double window_time() const;
  bool goes_on_straight(const WayItem& item) const;
  void plan_straight();
  void plan_window(bool to_stop);
  bool keep_limits(NodePlan& plan, WindowLaw& law);
  bool keep_limits_slowly(NodePlan& plan, WindowLaw& law);
  void go_gently();
  void read_stations();
  NodePlan solved(std::vector<double> x, const NodePlan* before, Trim trim);
  WindowLaw law_of_plan(const NodePlan& plan) const;
  std::vector<Excess> logged_excess(const std::vector<LawKnot>& law, double until) const;
  double slowness(std::vector<LawKnot> law, double until);
  void carry_out(std::vector<LawKnot> law);
  void append(const NodePlan& plan, const WindowLaw& law, bool to_stop);
  void rest_here();
  void hand_out(double t_final);
  void give(Segment segment);
  Segment cut(WayItem& item, double t0, double t1);

  JointLimits limits_;
  JerkWindow window_;
  LogSamples samples_;
  std::deque<WayItem> items_;
  double ramp_time_ = 0;
  bool straight_ = true;  ///< one straight run so far, from rest
  double waiting_ = 0;    ///< second-order time of the items, s
  double next_plan_ = 0;  ///< at which it is worth planning again
  std::vector<Segment> ready_;
  std::vector<LawKnot> law_;  ///< x(t) of the stretch from the last cut on
  double final_t_ = 0;        ///< the law is final up to here
  double law_end_ = 0;        ///< the last plan rests here
  double rest_x_ = 0;         ///< and this is where
  double cut_t_ = 0;          ///< end of the last segment that went out
  double clock_ = 0;          ///< program time there, s
  std::uint64_t windows_ = 0, newton_steps_ = 0;
  std::string problem_;  ///< why a limit is passed on the stretch that goes out; mostly empty
};

}  // namespace aircut::plan
