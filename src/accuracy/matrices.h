// Measured compliance matrices: what a passive joint allows, repairs of mounted-the-other-way
// probes, moving the base point, and the fit of a bench test.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accuracy/structure.h"

namespace aircut::accuracy {

enum class SignPolicy {
  check,        ///< a matrix that is not passive is an error
  as_given,     ///< used unchanged
  row_flip,     ///< a row with a negative diagonal is turned: the probe stood the other way round
  column_flip,  ///< a column is turned: the load's direction was noted the other way round
  abs_diagonal  ///< only the diagonal entry changes its sign
};

struct Passivity {
  Vec3 eigenvalues = Vec3::Zero();  ///< of the symmetric part, rising
  double asymmetry = 0;             ///< ‖A − Aᵀ‖ / ‖A + Aᵀ‖
  /// No joint gives energy back: no eigenvalue below −1e-6 of the largest.
  bool passive() const;
};

Passivity passivity(const Mat3& matrix);

struct Repair {
  SignPolicy policy = SignPolicy::check;
  bool symmetrize = false;   ///< then (A + Aᵀ)/2
  bool psd_project = false;  ///< then negative eigenvalues of the symmetric matrix become 0
};

/// Appends to `changes` what it did, one phrase each.
Mat3 repaired(const Mat3& matrix, const Repair& repair, std::vector<std::string>& changes);

/// The compliance in the machine frame of one stated in axes that are the columns of R.
Compliance rotated(const Compliance& compliance, const Mat3& R);
/// The same joint stated for the base point that is `shift` away; exact for a symmetric ξ.
Compliance shifted(const Compliance& compliance, const Vec3& shift);

struct CentreOfCompliance {
  Vec3 shift = Vec3::Zero();  ///< from the base point
  double residual = 0;  ///< ‖c − [ρ]ξ‖ that is left there; 0 when e and ξ alone say all
};
/// The base point for which the coupling is least.
CentreOfCompliance centre_of_compliance(const Compliance& compliance);

/// Two supports of one body at one base point (steady rest, sub spindle on the same bar). Nothing
/// when one of them can't be inverted.
std::optional<Compliance> in_parallel(const Compliance& a, const Compliance& b);

/// Slope of the least-squares line through zero: e of loads and readings, ξ of moments and angles.
double fit_through_zero(std::span<const double> loads, std::span<const double> readings);
/// Angle from the readings of two probes `apart`, all in one unit; rad.
double probe_angle(double d1, double d2, double apart);
/// max |loading − unloading| / max |reading|: a lower bound of the scatter ε of the stiffness.
double hysteresis(std::span<const double> loading, std::span<const double> unloading);

}  // namespace aircut::accuracy
