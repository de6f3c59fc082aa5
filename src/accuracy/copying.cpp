// Newton on r_k(t) = t_k + Σ_l h_kl(t_l) − t0_k with the Jacobian I + ∂h_kl/∂t_l. A form error of
// the blank moves t0, so the real depths move by J⁻¹ and the surface keeps I − J⁻¹ of it: the copy
// ratio, q/(1 + q) for a single tool.
#include "accuracy/copying.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace aircut::accuracy {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd displacement(const CopyingProblem& problem, const VectorXd& t) {
  VectorXd w = VectorXd::Zero(t.size());
  for (Eigen::Index k = 0; k < t.size(); ++k)
    for (Eigen::Index l = 0; l < t.size(); ++l)
      w[k] += problem.shares[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)].at(t[l]);
  return w;
}

MatrixXd jacobian(const CopyingProblem& problem, const VectorXd& t) {
  MatrixXd J = MatrixXd::Identity(t.size(), t.size());
  for (Eigen::Index k = 0; k < t.size(); ++k)
    for (Eigen::Index l = 0; l < t.size(); ++l)
      J(k, l) +=
          problem.shares[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)].slope(t[l]);
  return J;
}

// A real eigenvalue at or below 0: a depth runs away along its vector. Of one tool that is 1 + q.
bool runs_away(const MatrixXd& J) {
  const auto values = Eigen::EigenSolver<MatrixXd>(J, false).eigenvalues();
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (values[i].imag() == 0 && values[i].real() <= 0) return true;
  return false;
}

}  // namespace

CopyingResult solve_copying(const CopyingProblem& problem) {
  constexpr int most_iterations = 30;
  constexpr double tolerance = 1e-9;  // mm
  const VectorXd t0 =
      Eigen::Map<const VectorXd>(problem.t0.data(), static_cast<Eigen::Index>(problem.t0.size()));
  VectorXd t = t0;
  CopyingResult out;
  out.unstable = runs_away(jacobian(problem, t));
  while (!out.unstable && !out.converged && out.iterations < most_iterations) {
    const VectorXd step =
        jacobian(problem, t).partialPivLu().solve(t0 - t - displacement(problem, t));
    t += step;
    ++out.iterations;
    if (!t.allFinite()) break;
    out.converged = step.cwiseAbs().maxCoeff() < tolerance;
  }
  const MatrixXd J = out.converged ? jacobian(problem, t) : MatrixXd();
  if (out.converged && runs_away(J)) {
    out.unstable = true;
    out.converged = false;
  }
  if (!out.converged) t = t0;  // the uncoupled result
  const VectorXd w = out.converged ? VectorXd(t0 - t) : displacement(problem, t0);
  out.t.assign(t.data(), t.data() + t.size());
  out.w.assign(w.data(), w.data() + w.size());
  if (out.converged) out.ratio = MatrixXd::Identity(t.size(), t.size()) - J.inverse();
  return out;
}

}  // namespace aircut::accuracy
