// The depth that a yielding machine really cuts: forces push the tools away, less depth means less
// force. Solved for all engaged tools together.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "accuracy/scatter.h"

namespace aircut::accuracy {

/// Tool k's depth is t0 − displacement(t): `shares[k][l]` is the displacement of tool k along its
/// normal, away from the work, that tool l causes.
struct CopyingProblem {
  std::vector<double> t0;
  std::vector<std::vector<ToolShare>> shares;
};

struct CopyingResult {
  std::vector<double> t;  ///< real depths, mm
  std::vector<double> w;  ///< t0 − t
  /// How much of a form error of blank l shows up on the surface of tool k: ∂w_k/∂t0_l.
  Eigen::MatrixXd ratio;
  bool converged = false;
  int iterations = 0;
  /// The displacement's slope is so far below 0 that no depth is at rest (1 + q ≤ 0).
  bool unstable = false;
};

/// Newton's method from t0, at most 30 steps, to 1e-9 mm.
CopyingResult solve_copying(const CopyingProblem& problem);

}  // namespace aircut::accuracy
