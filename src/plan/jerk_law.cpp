// Places and times of a law. Its speed is never negative, so the time of a place is found by
// bisection, with Newton's steps where they stay inside.
#include "plan/jerk_law.h"

#include <algorithm>

namespace aircut::plan {

std::size_t knot_at(const std::vector<LawKnot>& law, double t) {
  const auto after = std::upper_bound(law.begin(), law.end(), t,
                                      [](double time, const LawKnot& k) { return time < k.t; });
  return after == law.begin() ? 0 : static_cast<std::size_t>(after - law.begin() - 1);
}

LawKnot state_at(const std::vector<LawKnot>& law, double t) {
  LawKnot k = law[knot_at(law, t)];
  const double tau = t - k.t;
  k.t = t;
  k.x = k.way(tau);
  k.v = k.speed(tau);
  k.a += tau * k.j;
  return k;
}

double time_at(const std::vector<LawKnot>& law, double x) {
  const auto after = std::upper_bound(law.begin(), law.end(), x,
                                      [](double way, const LawKnot& k) { return way < k.x; });
  if (after == law.begin()) return law.front().t;
  if (after == law.end()) return law.back().t;
  const LawKnot& k = *(after - 1);
  double low = 0, high = after->t - k.t, tau = high / 2;
  for (int i = 0; i < 60; ++i) {
    const double miss = k.way(tau) - x;
    (miss > 0 ? high : low) = tau;
    if (!(high - low > 1e-15 * after->t)) break;
    const double slope = k.speed(tau);
    const double newton = tau - miss / slope;
    const bool inside = newton > low && newton < high;
    const double next = inside ? newton : (low + high) / 2;
    if (inside && std::abs(next - tau) < 1e-16 + 1e-15 * after->t) break;
    tau = next;
  }
  return k.t + tau;
}

void slow_down(std::vector<LawKnot>& law, double factor) {
  const double t0 = law.front().t;
  for (LawKnot& k : law) {
    k.t = t0 + factor * (k.t - t0);
    k.v /= factor;
    k.a /= factor * factor;
    k.j /= factor * factor * factor;
  }
}

}  // namespace aircut::plan
