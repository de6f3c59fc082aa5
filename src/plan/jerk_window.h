// Private: a window of the jerk stage: what it is planned from, the squared speeds at its nodes,
// and the time law that follows from them.
#pragma once

#include <vector>

#include "machine/machine.h"
#include "plan/jerk_law.h"

namespace aircut::plan {

/// How much of the limits a plan may use at each node.
struct Trim {
  std::vector<double> jerk, speed;
};

/// Where a window begins: at rest, or at the node behind the last cell that is final.
struct WindowStart {
  bool from_rest = true;
  double x = 0, b = 0;
  double time = 0, u = 0;       ///< of the cell before: duration and path acceleration
  std::vector<double> q;        ///< of the cell before: joint accelerations, shares of the limits
  std::vector<double> known_x;  ///< the last plan's first nodes from the start on
  Trim known;                   ///< and what it could use there
  std::vector<double> rest_x, rest_b;  ///< all of its nodes from the start on, with its b
};

/// A place of the way where the second-order profile and the joints' rates are known.
struct Station {
  double x = 0, b = 0;
};

struct JerkWindow {
  std::size_t joints = 0;
  machine::JointVector rate;  ///< jerk limit over acceleration limit by joint, 1/s
  double period = 0;          ///< of the log, s
  double brake_time = 0;      ///< from the highest speed to rest, at most, s
  WindowStart start;
  std::vector<Station> stations;    ///< up to the end of the way
  std::vector<double> alpha, beta;  ///< q'/A and q''/A by x at the stations, rows of `joints`

  double end() const { return stations.back().x; }
  /// q'/A by x, by cubic Hermite interpolation. `station` only grows with x.
  void rates_at(double x, std::size_t& station, double* out) const;
};

/// Squared speeds over nodes.
struct NodePlan {
  std::vector<double> x, b;
  Trim trim;
  std::vector<double> cap;  ///< of b, with the trim
  std::vector<double> q;    ///< joint accelerations by cell, joint after joint
  std::vector<Cause> cause;
  bool good = false;
  std::uint64_t steps = 0;  ///< of the solver
};

/// A plan's time law.
struct WindowLaw {
  std::vector<LawKnot> knots;     ///< the last one is the rest at the end
  std::vector<double> time, u;    ///< by cell: duration, path acceleration
  std::vector<double> node_time;  ///< by node
};

/// The largest path jerk from a stop that the joints' rates `alpha` (q'/A) allow.
double path_jerk(const double* alpha, const machine::JointVector& rate);
/// y at x on the straight between two points; outside them the nearer one's.
double linear(double x, double x0, double x1, double y0, double y1);

/// The fastest plan over nodes at `x`. `before`: a plan that is nearly it, or null.
NodePlan solve_on(const JerkWindow& window, std::vector<double> x, const NodePlan* before,
                  Trim trim);
/// `at`: the law so far, at the end of what is final; at rest only its place and time count.
WindowLaw law_of(const JerkWindow& window, const NodePlan& plan, LawKnot at);
/// Plan and law of a window that starts at rest, carried out in `factor` times the time.
void slow_down(NodePlan& plan, WindowLaw& law, double factor);

}  // namespace aircut::plan
