// Private: the jerk limit. Pieces come in with their second-order time law and go out with one of
// third order.
#pragma once

#include <deque>
#include <vector>

#include "plan/grid.h"

namespace aircut::plan {

class JerkStage {
 public:
  /// `rate`: jerk limit over acceleration limit by joint, 1/s; infinite = none.
  JerkStage(const JointLimits& limits, machine::JointVector rate, double period);

  /// A piece with its fastest second-order profile. `scale`: path speed here per path speed at the
  /// end of the piece before.
  void push(Segment segment, Grid grid, double scale);
  /// A segment without way; it comes out behind the piece before it.
  void push_still(Segment segment);
  /// The last piece ends at rest.
  void stop();
  /// Segments whose time law is final, in order.
  std::vector<Segment> take();

 private:
  struct Item {
    Segment segment;
    Grid grid;
    double begin = 0;    ///< on the common way x of the stretch
    double stretch = 1;  ///< dx/ds
    std::vector<Segment> after;
    double end() const { return begin + stretch * grid.length(); }
  };
  /// A place of the way where the second-order profile and the joints' rates are known.
  struct Station {
    double x = 0, b = 0;
    std::size_t item = 0;
  };
  struct LawKnot {
    double t = 0, x = 0, v = 0, a = 0, j = 0;
    LimitedBy cause = LimitedBy::none;
  };
  /// Where a window begins: at rest, or at the node behind the last cell that is final.
  struct Start {
    bool from_rest = true;
    double x = 0, b = 0;
    double time = 0, u = 0;  ///< of the cell before: duration and path acceleration
    std::vector<double> q;   ///< of the cell before: joint accelerations, shares of the limits
  };
  /// How much of the limits a plan may use at each node.
  struct Trim {
    std::vector<double> jerk, speed;
  };
  /// Squared speeds over nodes.
  struct Plan {
    std::vector<double> x, b;
    Trim trim;
    std::vector<double> q;  ///< joint accelerations by cell, joint after joint
    std::vector<LimitedBy> cause;
    bool good = false;
  };
  /// A plan's time law.
  struct Law {
    std::vector<LawKnot> knots;     ///< the last one is the rest at the end
    std::vector<double> time, u;    ///< by cell: duration, path acceleration
    std::vector<double> node_time;  ///< by node
  };
  /// A place of an estimated ride, for the choice of nodes.
  struct Place {
    double x, v, t;
    double target;  ///< wanted duration of a cell here, s
    double count;   ///< cells before it
    bool active;    ///< something changes here
  };
  class Mesher;

  double way_end() const { return items_.back().end(); }
  bool goes_on_straight(const Item& item) const;
  void plan_straight();
  void plan_window(bool to_stop);
  double window_time() const;
  void read_stations();
  Plan solve_on(std::vector<double> x, const Plan* before, Trim trim) const;
  Law law_of(const Plan& plan) const;
  void take_drift_back(std::vector<LawKnot>& knots, double way, double speed, double t_end) const;
  void append(const Plan& plan, const Law& law, bool to_stop);
  static bool is_fine(const std::vector<double>& time, const std::vector<double>& wanted);
  bool keeps_jerk(const Law& law, bool slower, Trim& trim) const;
  void rates_at(double x, std::size_t& station, double* alpha) const;
  void mark_bends(std::vector<Place>& places) const;
  LawKnot state_at(double t) const;
  void put_targets(std::vector<Place>& places, double step) const;
  static void place_counts(std::vector<Place>& places);
  std::vector<double> mesh_on(const Law& law, double step, std::vector<double>& wanted) const;
  void rest_here();
  void hand_out(double t_final);
  Segment cut(Item& item, double t0, double t1) const;
  double time_at(double x) const;
  std::size_t knot_at(double t) const;

  machine::JointVector a_;     ///< acceleration limits
  machine::JointVector rate_;  ///< jerk over acceleration, 1/s
  double period_;
  double brake_time_ = 0;  ///< from the highest speed to rest, at most
  std::size_t joints_;
  std::deque<Item> items_;
  bool straight_ = true;  ///< one straight run so far, from rest
  double waiting_ = 0;    ///< second-order time of the items, s
  double next_plan_ = 0;  ///< at which it is worth planning again
  std::vector<Segment> ready_;
  Start start_;
  std::vector<LawKnot> law_;  ///< x(t) of the stretch from the last cut on
  double final_t_ = 0;        ///< the law is final up to here
  double law_end_ = 0;        ///< the last plan rests here
  double rest_x_ = 0;         ///< and this is where
  double cut_t_ = 0;          ///< end of the last segment that went out
  std::vector<Station> stations_;
  std::vector<double> alpha_, beta_;  ///< q'/A and q''/A by x at the stations, rows of joints_
};

}  // namespace aircut::plan
