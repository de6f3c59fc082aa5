// A joint stores ½ fᵀ e f when it is loaded, so the symmetric parts of e and ξ have no negative
// eigenvalues. Measured tables do have some; the usual reason is a probe or a load with the sign of
// the other direction, which turns a whole row or column.
#include "accuracy/matrices.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace aircut::accuracy {
namespace {

constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

Mat3 flipped(Mat3 A, SignPolicy policy, std::vector<std::string>& changes) {
  if (policy == SignPolicy::check || policy == SignPolicy::as_given) return A;
  for (int i = 0; i < 3; ++i) {
    if (!(A(i, i) < 0)) continue;
    const std::string axis(1, axis_names[static_cast<std::size_t>(i)]);
    if (policy == SignPolicy::row_flip) {
      A.row(i) *= -1;
      changes.push_back("row " + axis + " turned");
    } else if (policy == SignPolicy::column_flip) {
      A.col(i) *= -1;
      changes.push_back("column " + axis + " turned");
    } else {
      A(i, i) *= -1;
      changes.push_back("diagonal " + axis + axis + " turned");
    }
  }
  return A;
}

}  // namespace

bool Passivity::passive() const {
  return !(eigenvalues[0] < -1e-6 * eigenvalues.cwiseAbs().maxCoeff());
}

Passivity passivity(const Mat3& matrix) {
  const Mat3 sum = matrix + matrix.transpose(), difference = matrix - matrix.transpose();
  Passivity out;
  out.eigenvalues = Eigen::SelfAdjointEigenSolver<Mat3>(0.5 * sum).eigenvalues();
  if (difference.norm() > 0) out.asymmetry = difference.norm() / std::max(sum.norm(), 1e-300);
  return out;
}

Mat3 repaired(const Mat3& matrix, const Repair& repair, std::vector<std::string>& changes) {
  Mat3 A = flipped(matrix, repair.policy, changes);
  if ((repair.symmetrize || repair.psd_project) && A != A.transpose()) {
    A = (0.5 * (A + A.transpose())).eval();
    changes.push_back("made symmetric");
  }
  if (repair.psd_project) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(A);
    if (solver.eigenvalues()[0] < 0) {
      A = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal() *
          solver.eigenvectors().transpose();
      changes.push_back("negative eigenvalues set to 0");
    }
  }
  return A;
}

Compliance rotated(const Compliance& compliance, const Mat3& R) {
  return {R * compliance.e * R.transpose(), R * compliance.c * R.transpose(),
          R * compliance.xi * R.transpose()};
}

Compliance shifted(const Compliance& compliance, const Vec3& shift) {
  Body body;
  body.compliance = compliance;
  return {body_influence(body, shift, shift).topLeftCorner<3, 3>(),
          compliance.c - skew(shift) * compliance.xi, compliance.xi};
}

CentreOfCompliance centre_of_compliance(const Compliance& compliance) {
  // [ρ]ξ is linear in ρ: nine equations, three unknowns.
  Eigen::Matrix<double, 9, 3> A;
  for (int i = 0; i < 3; ++i) {
    const Mat3 column = skew(Vec3::Unit(i)) * compliance.xi;
    A.col(i) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(column.data());
  }
  const Eigen::Matrix<double, 9, 1> b =
      Eigen::Map<const Eigen::Matrix<double, 9, 1>>(compliance.c.data());
  CentreOfCompliance out;
  out.shift = A.completeOrthogonalDecomposition().solve(b);
  out.residual = (b - A * out.shift).norm();
  return out;
}

std::optional<Compliance> in_parallel(const Compliance& a, const Compliance& b) {
  const auto joined = [](const Compliance& C) {
    Mat6 out;
    out << C.e, C.c, C.c.transpose(), C.xi;
    return out;
  };
  // Translations and rotations differ in unit and size: scaled to a common size before the test.
  const double size = std::sqrt(std::max({a.xi.norm(), b.xi.norm(), 1e-300}) /
                                std::max({a.e.norm(), b.e.norm(), 1e-300}));
  Eigen::Matrix<double, 6, 1> scale;
  scale << size, size, size, 1, 1, 1;
  const Mat6 A = scale.asDiagonal() * joined(a) * scale.asDiagonal();
  const Mat6 B = scale.asDiagonal() * joined(b) * scale.asDiagonal();
  Eigen::FullPivLU<Mat6> lu_a(A), lu_b(B);
  lu_a.setThreshold(1e-12);
  lu_b.setThreshold(1e-12);
  if (!lu_a.isInvertible() || !lu_b.isInvertible()) return std::nullopt;
  Eigen::FullPivLU<Mat6> sum(Mat6(lu_a.inverse() + lu_b.inverse()));
  if (!sum.isInvertible()) return std::nullopt;
  const Mat6 C =
      scale.cwiseInverse().asDiagonal() * sum.inverse() * scale.cwiseInverse().asDiagonal();
  return Compliance{C.topLeftCorner<3, 3>(), C.topRightCorner<3, 3>(), C.bottomRightCorner<3, 3>()};
}

double fit_through_zero(std::span<const double> loads, std::span<const double> readings) {
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    products += loads[i] * readings[i];
    squares += loads[i] * loads[i];
  }
  return squares > 0 ? products / squares : 0;
}

double probe_angle(double d1, double d2, double apart) { return std::atan((d2 - d1) / apart); }

double hysteresis(std::span<const double> loading, std::span<const double> unloading) {
  double width = 0, most = 0;
  for (std::size_t i = 0; i < loading.size(); ++i) {
    width = std::max(width, std::abs(loading[i] - unloading[i]));
    most = std::max({most, std::abs(loading[i]), std::abs(unloading[i])});
  }
  return most > 0 ? width / most : 0;
}

}  // namespace aircut::accuracy
