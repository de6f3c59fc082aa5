// Private: what the joint log will see of a law, and where it is too much.
#pragma once

#include <deque>
#include <vector>

#include "plan/grid.h"
#include "plan/jerk_window.h"

namespace aircut::plan {

/// A piece on the common way x of a stretch.
struct WayItem {
  Segment segment;
  Grid grid;
  double begin = 0;            ///< x
  double stretch = 1;          ///< dx/ds
  std::vector<Segment> after;  ///< segments without way behind it
  double end() const { return begin + stretch * grid.length(); }
};

/// A time of a law at which more than a joint's limit is seen, or more than the feed.
struct Excess {
  double t = 0;
  double share = 0;    ///< of the limit
  double allowed = 0;  ///< of the feed: the path speed that keeps it; 0: of a joint's limit
};

/// Jerks as differences over the period see them, wherever the samples fall; from the rates at the
/// stations, so only nearly.
std::vector<Excess> jerk_excess(const JerkWindow& window, const WindowLaw& law);
/// Nodes near an excess get less of the jerk limit, and of the speed too if `slower`; those around
/// an excess of the feed the feed's speed.
void trim_around(const std::vector<Excess>& excess, const JerkWindow& window, const NodePlan& plan,
                 const WindowLaw& law, bool slower, Trim& trim);

/// The samples of the log, computed as the log does it.
class LogSamples {
 public:
  /// `start`: joints at program time 0. `limits` must outlive this.
  LogSamples(const machine::Kinematics& kinematics, const JointLimits& limits,
             machine::JointVector start, double period);

  /// A segment that is final begins at this program time.
  void pass(const Segment& segment, double clock);

  /// A law whose time `t` is the program time clock + (t − cut). Up to `cut` segments have passed.
  struct Ride {
    const std::deque<WayItem>& items;
    const std::vector<LawKnot>& before;  ///< up to the begin of `law`; empty when that is at rest
    const std::vector<LawKnot>& law;
    double clock = 0, cut = 0;
  };
  /// Where differences of the samples pass a limit of acceleration or jerk, or the feed, from the
  /// law's begin up to its time `until`. The machine stands behind the end.
  std::vector<Excess> excess(const Ride& ride, double until) const;

 private:
  class Reader;
  struct Sample {
    double number;
    machine::JointVector q;
    AxisValues tip;
    double feed = 0;  ///< commanded; 0: none counts
  };
  const Sample& before(double number) const;
  static double feed_share(const Sample& from, const Sample& to, double period);

  const machine::Kinematics& kinematics_;
  const JointLimits& limits_;
  double period_;
  std::deque<Sample> past_;  ///< the last four that are final
};

}  // namespace aircut::plan
