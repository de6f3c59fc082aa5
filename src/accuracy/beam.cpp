// A beam's influence function by the force method. Everything comes from the cantilever
//
//   c(p, q) = ∫ from 0 to min(p, q) of (p − s)(q − s) / EI(s) ds          (unit load theorem)
//
// which is a sum of cubics over the sections, so steps in the shaft are exact.
//
//   chuck         G(x, a) = c(x, a)
//   chuck+centre  the centre takes R = c(l, a) / (c(l, l) + e_B):   G = c(x, a) − R c(x, l)
//   centres       the reactions are 1 − a/l and a/l. Clamp the beam at 0, load it with 1 at a and
//   −a/l at
//                 l (so the clamp carries no moment), then move it as a rigid body onto its
//                 supports: G = c(x,a) − (a/l) c(x,l) − (x/l) c(l,a) + (x a/l²) c(l,l)
//                     + e_A (1 − x/l)(1 − a/l) + e_B (x/l)(a/l)
//
// Slopes are the derivatives of these sums. Axial give and torsion of the beam are left out.
#include "accuracy/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::accuracy {
namespace {

BeamInfluence cantilever(const std::vector<BeamSection>& sections, double p, double q) {
  BeamInfluence out;
  const double end = std::min(p, q);
  double from = 0;
  for (const BeamSection& section : sections) {
    const double to = std::min(section.end, end);
    if (to <= from) break;
    const double flexibility = 1 / section.stiffness;
    const double h = to - from, m = 0.5 * (from + to);
    // Moments of the interval about its middle keep long beams exact.
    const double P = p - m, Q = q - m;
    out.deflection += flexibility * (P * Q * h + h * h * h / 12);
    out.slope += flexibility * Q * h;
    out.load_slope += flexibility * P * h;
    out.cross_slope += flexibility * h;
    from = to;
  }
  return out;
}

}  // namespace

Beam round_beam(double length, double diameter, double youngs_modulus, Held held) {
  Beam beam;
  const double inertia = std::numbers::pi * std::pow(diameter, 4) / 64;
  beam.sections = {{length, youngs_modulus * inertia}};
  beam.held = held;
  return beam;
}

BeamInfluence influence(const Beam& beam, double x, double a) {
  const double l = beam.length();
  const auto c = [&](double p, double q) { return cantilever(beam.sections, p, q); };
  BeamInfluence out = c(x, a);
  if (beam.held == Held::chuck) return out;
  const BeamInfluence xl = c(x, l), la = c(l, a), ll = c(l, l);
  if (beam.held == Held::chuck_centre) {
    const double give = ll.deflection + beam.e_centre;
    out.deflection -= xl.deflection * la.deflection / give;
    out.slope -= xl.slope * la.deflection / give;
    out.load_slope -= xl.deflection * la.load_slope / give;
    out.cross_slope -= xl.slope * la.load_slope / give;
    return out;
  }
  const double u = x / l, v = a / l;
  const double e_A = beam.e_clamp, e_B = beam.e_centre;
  out.deflection += -v * xl.deflection - u * la.deflection + u * v * ll.deflection +
                    e_A * (1 - u) * (1 - v) + e_B * u * v;
  out.slope += -v * xl.slope + (-la.deflection + v * ll.deflection - e_A * (1 - v) + e_B * v) / l;
  out.load_slope +=
      -u * la.load_slope + (-xl.deflection + u * ll.deflection - e_A * (1 - u) + e_B * u) / l;
  out.cross_slope += (-xl.slope - la.load_slope + (ll.deflection + e_A + e_B) / l) / l;
  return out;
}

}  // namespace aircut::accuracy
