// Private: a time law x(t) of third order, cubics in a row.
#pragma once

#include <vector>

#include "plan/plan.h"

namespace aircut::plan {

/// From `t` on: x(τ) = x + vτ + aτ²/2 + jτ³/6 with τ = time − t.
struct LawKnot {
  double t = 0, x = 0, v = 0, a = 0, j = 0;
  Cause cause;

  double way(double tau) const { return x + tau * (v + tau * (a / 2 + tau * j / 6)); }
  double speed(double tau) const { return v + tau * (a + tau * j / 2); }
};

/// Of a law that is not empty; the last knot is the rest at its end.
std::size_t knot_at(const std::vector<LawKnot>& law, double t);
LawKnot state_at(const std::vector<LawKnot>& law, double t);
/// When the law passes x.
double time_at(const std::vector<LawKnot>& law, double x);
/// The law in the time from t0 on, with times that are `factor` as long: speeds are divided by the
/// factor, accelerations by its square, jerks by its cube.
void slow_down(std::vector<LawKnot>& law, double factor);

}  // namespace aircut::plan
