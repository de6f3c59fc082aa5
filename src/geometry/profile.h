// A solid of revolution about +Z given by its outline: tools, holders, cylinders of stock.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace aircut {

/// A point of the outline: radius r ≥ 0 and height z, mm.
struct ProfilePoint {
  double r = 0;
  double z = 0;
};

/// Chain of straight pieces from the lowest point on the axis to the highest; z never decreases
/// except along a level piece. The ends are closed to the axis by level pieces if r > 0 there.
using Profile = std::vector<ProfilePoint>;

/// A closed mesh that contains the solid of revolution and is at most `tolerance` mm larger in
/// radius (the safe side for a collision check). The number of facets follows from the largest
/// radius: R (1/cos(π/n) − 1) ≤ tolerance, n at least 12 and a multiple of 4; a tolerance below a
/// millionth of R counts as that. Empty when no point has r > 0.
TriangleMesh revolve(const Profile& profile, double tolerance);

}  // namespace aircut
