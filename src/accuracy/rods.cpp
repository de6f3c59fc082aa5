// A cantilever of length l about its middle: e = l³/12EI across and l/EA along, ξ = l/EI across and
// l/GJ along, and no coupling. A tip load then has the arm l/2 and gives l³/12EI + l (l/2)²/EI =
// l³/3EI.
#include "accuracy/rods.h"

#include <cmath>
#include <numbers>

namespace aircut::accuracy {

Body rod_body(const Rod& rod) {
  const double l = rod.length, E = rod.youngs_modulus;
  const double inertia = std::numbers::pi * std::pow(rod.diameter, 4) / 64;
  const double area = std::numbers::pi * rod.diameter * rod.diameter / 4;
  const double shear = E / (2 * (1 + rod.poisson));
  const Mat3 along = rod.axis * rod.axis.transpose();
  const Mat3 across = Mat3::Identity() - along;
  Body body;
  body.base_point = rod.clamp + 0.5 * l * rod.axis;
  body.compliance.e = l * l * l / (12 * E * inertia) * across + l / (E * area) * along;
  body.compliance.xi = l / (E * inertia) * across + l / (shear * 2 * inertia) * along;
  return body;
}

std::vector<Body> stepped_bodies(const Rod& first, std::span<const RodStep> steps) {
  std::vector<Body> out;
  Rod rod = first;
  for (const RodStep& step : steps) {
    rod.length = step.length;
    rod.diameter = step.diameter;
    rod.youngs_modulus = step.youngs_modulus;
    out.push_back(rod_body(rod));
    out.back().parent = static_cast<int>(out.size()) - 2;
    rod.clamp += step.length * rod.axis;
  }
  return out;
}

}  // namespace aircut::accuracy
