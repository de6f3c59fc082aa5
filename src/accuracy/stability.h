// Chatter limits: turning with one mode, and milling by the zeroth-order solution.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "accuracy/milling.h"

namespace aircut::accuracy {

/// One vibration mode at the tool's tip.
struct Mode {
  double stiffness = 0;                            ///< N/mm
  double frequency = 0;                            ///< natural, Hz
  double damping = 0;                              ///< ratio
  std::complex<double> response(double hz) const;  ///< mm/N
};

/// Smallest limit of the chip width over all speeds, mm; `force`: N/mm² along the mode. The
/// response's least real part is −1 / (4 k ζ (1 + ζ)), and the limit −1 / (2 force Re G): J.
/// Tlusty, M. Polacek, The stability of machine tools against self-excited vibrations in machining,
/// 1963.
double turning_limit(const Mode& mode, double force);

struct MillingLimit {
  std::complex<double> eigenvalue;
  double kappa = 0;  ///< ratio of its imaginary to its real part
  double depth = 0;  ///< a_p, mm
  std::vector<double> rpm;
};
/// Depths at which the cut chatters with `hz`, with the spindle speeds of lobes 0 … lobes−1; up to
/// two, those with a depth above 0. K_t N/mm², K_r its ratio of the radial to the tangential force.
std::vector<MillingLimit> milling_limits(int teeth, const Engagement& phi, double K_t, double K_r,
                                         const Mode& x, const Mode& y, double hz, int lobes);
/// The smallest depth a_p that chatters at a spindle speed, mm; nothing when none does. For the
/// same mode along and across the feed.
std::optional<double> milling_depth_limit(int teeth, const Engagement& phi, double K_t, double K_r,
                                          const Mode& mode, double rpm);

}  // namespace aircut::accuracy
