// Work held as a beam: between chuck and centre, between centres, or in the chuck alone. A closed
// loop of supports is no tree of joints, so such work is one body with an influence function.
#pragma once

#include <vector>

#include "geometry/geometry.h"

namespace aircut::accuracy {

/// A piece of a beam with one bending stiffness, from the end of the piece before it.
struct BeamSection {
  double end = 0;        ///< distance of its far end from the clamp, mm
  double stiffness = 0;  ///< E·I, N·mm²
};

enum class Held {
  chuck,         ///< clamped at 0, free at its end
  chuck_centre,  ///< clamped at 0, carried by a centre at its end
  centres,       ///< carried by centres at both ends
};

/// How a beam bends at x under a unit force at a, across its axis.
struct BeamInfluence {
  double deflection = 0;   ///< G(x, a), mm/N
  double slope = 0;        ///< ∂G/∂x, rad/N
  double load_slope = 0;   ///< ∂G/∂a: deflection per bending moment at a, mm/(N·mm)
  double cross_slope = 0;  ///< ∂²G/∂x∂a: slope per bending moment at a, rad/(N·mm)
};

struct Beam {
  Vec3 clamp = Vec3::Zero();  ///< where x = 0, in the machine frame, mm
  Vec3 axis = Vec3::UnitZ();  ///< unit vector from the clamp to the far end
  std::vector<BeamSection> sections;
  Held held = Held::chuck;
  double e_clamp = 0;   ///< give of the centre at x = 0 (`centres` only), mm/N
  double e_centre = 0;  ///< give of the centre at the far end, mm/N

  double length() const { return sections.empty() ? 0 : sections.back().end; }
};

/// A shaft of one diameter.
Beam round_beam(double length, double diameter, double youngs_modulus, Held held);

/// `x` and `a` are distances from the clamp, mm, inside [0, length].
BeamInfluence influence(const Beam& beam, double x, double a);

}  // namespace aircut::accuracy
