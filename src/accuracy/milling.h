// Cutting forces of end mills. Cutter frame: z along the tool's axis, up from the tip; x along the
// feed of the tool relative to the work; φ clockwise from +y seen from above, in which sense the
// cutter turns. All forces are on the tool. mm, rad, N, N·mm.
#pragma once

#include <vector>

#include "accuracy/turning.h"

namespace aircut::accuracy {

/// Per chip area (N/mm²) and per edge length (N/mm): tangential, radial, axial.
struct MillingCoefficients {
  double K_tc = 0, K_rc = 0, K_ac = 0;
  double K_te = 0, K_re = 0, K_ae = 0;
};

/// What an edge does to the tool for a chip thickness: six constants, or Kienzle's curve with fixed
/// ratios for the radial and axial parts.
struct EdgeLaw {
  MillingCoefficients constants;
  KienzleTerm kienzle;  ///< used when its k11 > 0
  double radial_ratio = 0.4, axial_ratio = 0;

  bool is_kienzle() const { return kienzle.k11 > 0; }
  /// Tangential, radial, axial force per mm of edge at thickness h > 0.
  Vec3 per_length(double h) const;
};

struct Cutter {
  enum class Shape { flat, ball, taper } shape = Shape::flat;
  int teeth = 1;
  double diameter = 0;    ///< of a taper: at its tip
  double helix = 0;       ///< negative: left hand
  double half_angle = 0;  ///< of a taper
  bool counter_clockwise = false;

  double pitch() const;  ///< angle between teeth
};

enum class MillingMode { up, down, slot };

struct Engagement {
  double start = 0, exit = 0;  ///< φ
};
/// `a_e` in (0, D]. Up: the material is on the +y side, down: on the −y side.
Engagement engagement(double diameter, double a_e, MillingMode mode);

struct MillingCut {
  double a_p = 0;  ///< depth along the axis
  double f_t = 0;  ///< feed per tooth
  Engagement phi;
};

struct MillingForce {
  Vec3 force = Vec3::Zero();
  double tangential = 0;  ///< sum over the engaged teeth
  double torque = 0;      ///< N·mm
};

/// Closed forms for a flat end mill and six constants.
MillingForce mean_force(const Cutter& cutter, const MillingCoefficients& K, const MillingCut& cut);
/// With tooth 0 at `theta` at its tip.
MillingForce force_at(const Cutter& cutter, const MillingCoefficients& K, const MillingCut& cut,
                      double theta);

/// Any shape and law, by quadrature along the edge (and over the engaged angle).
MillingForce mean_force(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut);
MillingForce force_at(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                      double theta);
/// The largest force in one tooth pitch, of at least 36 angles.
MillingForce peak_force(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut);

/// Chip thickness: the largest and the mean over the engaged angle of a flat end mill.
double thickest_chip(const MillingCut& cut);
double mean_chip(const MillingCut& cut);
/// The tooth feed that gives `h_max` at a radial width.
double feed_for_chip(double diameter, double a_e, double h_max);

/// How far the wall that a flat end mill leaves is off, mm along +y, by height from the tip: the
/// tool bends as a rod clamped `stickout` above its tip.
struct WallTool {
  double stickout = 0, effective_diameter = 0, youngs_modulus = 0;
};
std::vector<double> wall_error(const Cutter& cutter, const EdgeLaw& law, const MillingCut& cut,
                               MillingMode mode, const WallTool& tool,
                               const std::vector<double>& heights);

}  // namespace aircut::accuracy
