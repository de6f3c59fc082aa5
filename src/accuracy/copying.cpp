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
  if (!J.allFinite()) return false;
  const auto values = Eigen::EigenSolver<MatrixXd>(J, false).eigenvalues();
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (values[i].imag() == 0 && values[i].real() <= 0) return true;
  return false;
}

// Forces end at t = 0 with a steep slope, so a whole step may lead out of the work although the
// depth at rest is inside: then a tenth of the depth is the next guess. A tool that the others push
// out of the work may leave it.
template <class Residual>
VectorXd kept_in_the_work(const VectorXd& from, VectorXd to, const Residual& residual) {
  for (Eigen::Index k = 0; k < from.size(); ++k) {
    if (!(from[k] > 0 && to[k] <= 0)) continue;
    VectorXd at_surface = from;
    at_surface[k] = 0;
    if (residual(at_surface)[k] > 0) to[k] = from[k] / 10;
  }
  return to;
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
    const auto residual = [&](const VectorXd& at) {
      return VectorXd(t0 - at - displacement(problem, at));
    };
    const VectorXd r = residual(t);
    const VectorXd step = jacobian(problem, t).partialPivLu().solve(r);
    ++out.iterations;
    if (!step.allFinite()) break;
    out.converged = step.cwiseAbs().maxCoeff() < tolerance;
    t = kept_in_the_work(t, t + step, residual);
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
