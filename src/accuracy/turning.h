// Cutting forces in turning: power laws of depth, feed and speed, Kienzle's form turned into one,
// and the directions in which they act on the tool. mm, mm/rev, m/min, N.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "geometry/geometry.h"

namespace aircut::accuracy {

/// P = C t^x S^y V^z K, N.
struct PowerTerm {
  double C = 0;  ///< N (handbooks in kgf print a tenth of it)
  double x = 1, y = 1, z = 0;
  double K = 1;  ///< product of the correction factors

  double at(double t, double S, double V) const;
};

struct Interval {
  double low = 0, high = 0;
  bool holds(double value) const { return value >= low && value <= high; }
};

/// The three components that a cut puts on the tool.
struct TurningLaw {
  PowerTerm cut, thrust, feed;
  std::string source;  ///< where the coefficients come from
  std::optional<Interval> valid_t, valid_S, valid_V;
};

struct TurningForce {
  double cut = 0, thrust = 0, feed = 0;  ///< N
};
TurningForce turning_force(const TurningLaw& law, double t, double S, double V);

/// Kienzle's specific force k_c = k_c1.1 h^(−m), h = S sin κ, width t / sin κ.
struct KienzleTerm {
  double k11 = 0;  ///< N/mm²
  double m = 0;
  /// The power law that gives the same force for the entering angle κ (rad).
  PowerTerm power_law(double kappa) const;
};

/// While the depth is inside of the nose radius, κ is the mean angle of the engaged arc.
double effective_kappa(double kappa, double nose_radius, double t);

/// Directions of the force on the tool.
struct Triad {
  Vec3 cut = Vec3::Zero(), thrust = Vec3::Zero(), feed = Vec3::Zero();
};
/// `omega`: along the spindle axis, in the direction of its turn (right-hand rule); `arm`: from a
/// point of that axis to the tool's point; `feed`: unit velocity of the tool along the work;
/// `normal`: out of the material, across `feed`. Nothing at the axis itself, where nothing cuts.
std::optional<Triad> turning_triad(const Vec3& omega, const Vec3& arm, const Vec3& feed,
                                   const Vec3& normal);

/// What a cut along the axis from one diameter to another takes. `feed` mm/min.
struct TurningCut {
  double t = 0, S = 0;
  double V_outer = 0, V_mean = 0;  ///< m/min
  double Q = 0;                    ///< mm³/min
  double area = 0;                 ///< of the chip, from the volume: Q / (π D_mean n), mm²
};
TurningCut longitudinal_cut(double D_before, double D_after, double rpm, double feed);

/// Power at the motor, kW. `eta`: efficiency of the drive.
double turning_power(double P_cut, double V, double eta);
/// Largest feeds that keep a force and a motor power, mm/rev.
double feed_for_force(const PowerTerm& cut, double t, double V, double force);
double feed_for_power(const PowerTerm& cut, double t, double V, double power_kW, double eta);

/// Height of the marks that the nose leaves, mm.
double turned_roughness(double S, double nose_radius);

/// A drill's two lips, or a tap: force along the axis and moment about it.
struct AxialCut {
  double force = 0;   ///< N, against the feed
  double moment = 0;  ///< N·mm, against the turn
};
AxialCut drilling(const KienzleTerm& material, double diameter, double feed, double point_angle,
                  double feed_ratio, double chisel_factor);
AxialCut tapping(const KienzleTerm& material, double diameter, double pitch);

}  // namespace aircut::accuracy
