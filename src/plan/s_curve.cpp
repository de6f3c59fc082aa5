// Jerk up, hold, down; cruise; the same mirrored. With peak speed v the way of a ramp from rest is
// v t / 2 (its speed is point-symmetric about v / 2), where
//
//   v ≥ a²/j   t = v/a + a/j     the acceleration limit is reached
//   else       t = 2 √(v/j)
//
// The peak is the speed limit, or what two ramps without cruise leave:
//   v t(v) = L:   v = (−a²/j + √(a⁴/j² + 4 a L)) / 2,   or   v³ = L² j / 4
#include "plan/s_curve.h"

#include <algorithm>
#include <cmath>

namespace aircut::plan {

SpeedProfile s_curve(double length, const StraightLimits& limits) {
  const double a = limits.a, j = limits.j;
  if (std::isinf(j)) {
    const double v = std::min(limits.v, std::sqrt(a * length)), ramp = v / a;
    const double cruise = length / v - ramp;
    return {{{0, 0, 0, a, 0},
             {ramp, v * ramp / 2, v, 0, 0},
             {ramp + cruise, length - v * ramp / 2, v, -a, 0},
             {2 * ramp + cruise, length, 0, 0, 0}}};
  }
  const double knee = a * a / j;
  double v = std::cbrt(length * length * j / 4);
  if (v > knee) v = (std::sqrt(knee * knee + 4 * a * length) - knee) / 2;
  v = std::min(v, limits.v);
  const bool holds = v > knee;
  const double rise = holds ? a / j : std::sqrt(v / j);  // time of one jerk phase
  const double hold = holds ? v / a - a / j : 0;
  const double ramp = holds ? v / a + a / j : 2 * std::sqrt(v / j);
  const double cruise = std::max((length - v * ramp) / v, 0.0);
  SpeedProfile out;
  ProfileKnot at;
  const auto go = [&](double duration, double jerk, double acceleration) {
    if (!(duration > 0)) return;
    at.a = acceleration;
    at.j = jerk;
    out.knots.push_back(at);
    const double t = duration;
    at.s += t * (at.v + t * (acceleration / 2 + t * jerk / 6));
    at.v += t * (acceleration + t * jerk / 2);
    at.t += t;
  };
  const double top = rise * j;
  go(rise, j, 0);
  go(hold, 0, top);
  go(rise, -j, top);
  at.v = v;
  go(cruise, 0, 0);
  go(rise, -j, 0);
  go(hold, 0, -top);
  go(rise, j, -top);
  out.knots.push_back({at.t, length, 0, 0, 0});
  return out;
}

}  // namespace aircut::plan
