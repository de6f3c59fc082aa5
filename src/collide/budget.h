// What an earlier proof of a pair has left over, spent on a way that is known already.
#pragma once

#include <algorithm>

#include "collide/collide.h"

namespace aircut::collide {

/// Above this distance a pair needs no query, mm.
inline double far_floor(double margin, double resolution) {
  return std::max(margin, 0.5 * resolution);
}

/// Takes a way of at most `travel` mm off the budget; false, and nothing is taken, where that is
/// not enough to stay above `floor`.
inline bool spend(Budget& budget, double travel, double floor) {
  const double padded = travel * (1 + 1e-12);  // for the rounding of a sum of ways
  if (!(padded <= budget.distance - floor) || budget.distance <= floor) return false;
  budget.distance -= padded;
  return true;
}

}  // namespace aircut::collide
