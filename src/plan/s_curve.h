// Private: the fastest straight move from rest to rest under limits of speed, acceleration, jerk.
#pragma once

#include "plan/plan.h"

namespace aircut::plan {

struct StraightLimits {
  double v, a, j;  ///< all above 0; j may be infinite
};

/// Up to seven phases of constant jerk; the last knot is the end. Closed form.
SpeedProfile s_curve(double length, const StraightLimits& limits);

}  // namespace aircut::plan
