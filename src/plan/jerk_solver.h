// Private: the fastest squared speeds over a row of nodes under limits of joint acceleration and
// jerk.
#pragma once

#include <vector>

namespace aircut::plan {

/// Nodes 0 … N along x, cells 0 … N − 1 between them. b = ẋ² is linear in x within a cell, so the
/// path acceleration is constant there. The acceleration of joint j in cell k, as a share of its
/// limit, is Q = p b_k + r b_{k+1}. The motion ends at rest in node N.
struct JerkProblem {
  std::size_t joints = 0;
  std::vector<double> x;     ///< N + 1
  std::vector<double> cap;   ///< N + 1, largest b
  std::vector<double> p, r;  ///< joint after joint, N each
  std::vector<double> rate;  ///< by joint: jerk limit over acceleration limit, 1/s; may be infinite
  std::vector<double> share;  ///< N + 1: of the jerk limit that may be used at each node
  std::vector<double> guess;  ///< N + 1: where to start looking; above 0 inside
  bool from_rest = true;
  double b_start = 0;            ///< when not from rest
  std::vector<double> q_before;  ///< Q of the cell before the first
  double time_before = 0;        ///< its duration, s

  std::size_t cells() const { return x.size() - 1; }
};

struct JerkSolution {
  std::vector<double> b;
  double violation = 0;  ///< largest excess of a row as a share of its limit
  int rounds = 0;
};

/// `acceleration_room`: share of the acceleration limit that may be used.
JerkSolution solve(const JerkProblem& problem, double acceleration_room);

}  // namespace aircut::plan
