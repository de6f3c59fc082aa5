// Bodies made from geometry: overhung tools, work and stepped holders.
#pragma once

#include <span>
#include <vector>

#include "accuracy/structure.h"

namespace aircut::accuracy {

/// A round rod clamped at one end.
struct Rod {
  double length = 0;          ///< free length, mm
  double diameter = 0;        ///< mm; of a fluted part: the flute factor times its diameter
  double youngs_modulus = 0;  ///< N/mm²
  double poisson = 0.3;       ///< for torsion
  Vec3 clamp = Vec3::Zero();  ///< where it leaves its clamp, mm
  Vec3 axis = Vec3::UnitZ();  ///< unit vector towards the free end
};

/// The rod as one body with its base point at mid length, where its coupling is zero.
Body rod_body(const Rod& rod);

struct RodStep {
  double length = 0, diameter = 0, youngs_modulus = 0;
};
/// A stepped rod as bodies in series, from the clamp outwards: exact for loads at the tip. `first`
/// gives clamp, axis and Poisson's ratio. The bodies' parents are their places in the list, from 0;
/// the first hangs on ground.
std::vector<Body> stepped_bodies(const Rod& first, std::span<const RodStep> steps);

}  // namespace aircut::accuracy
