// The time law of a plan. The solver's acceleration u is constant in a cell. Around each node a
// ramp as long as the shorter neighbouring cell makes it continuous; jerk is then constant in
// pieces, so x(t) is a chain of cubics: known in closed form, with a speed that is never negative.
#include <algorithm>
#include <cmath>

#include "plan/jerk_window.h"

namespace aircut::plan {
namespace {

// Smoothing moves the way's end by less than a micrometre. From rest all is scaled; on the move, an
// acceleration A + J t is added that ends with the wanted way and speed.
void take_drift_back(const JerkWindow& w, std::vector<LawKnot>& knots, double way, double speed,
                     double t_end) {
  const LawKnot first = knots.front();
  if (w.start.from_rest) {
    const double scale = 1 + way / (w.end() - way - first.x);
    for (LawKnot& k : knots) {
      k.x = first.x + scale * (k.x - first.x);
      k.v *= scale;
      k.a *= scale;
      k.j *= scale;
    }
    return;
  }
  const double whole = t_end - first.t;
  const double j = 12 * (speed * whole / 2 - way) / (whole * whole * whole);
  const double a = speed / whole - j * whole / 2;
  for (LawKnot& k : knots) {
    const double t = k.t - first.t;
    k.x += t * t * (a / 2 + t * j / 6);
    k.v += t * (a + t * j / 2);
    k.a += a + t * j;
    k.j += j;
  }
}

}  // namespace

// The plan's time law, from the end of the final part on.
WindowLaw law_of(const JerkWindow& w, const NodePlan& plan, LawKnot at) {
  const std::size_t n = plan.x.size() - 1;
  WindowLaw law;
  law.time.resize(n);
  law.u.resize(n);
  law.node_time.resize(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    const double h = plan.x[k + 1] - plan.x[k];
    law.time[k] = 2 * h / (std::sqrt(plan.b[k]) + std::sqrt(plan.b[k + 1]));
    law.u[k] = (plan.b[k + 1] - plan.b[k]) / (2 * h);
  }
  at.x = w.start.from_rest ? w.start.x : at.x;
  at.v = w.start.from_rest ? 0 : at.v;
  at.a = w.start.from_rest ? 0 : w.start.u;
  const auto go = [&](double duration, double jerk, double acceleration, Cause cause) {
    if (!(duration > 0)) return;
    at.j = jerk;
    at.a = acceleration;
    at.cause = cause;
    law.knots.push_back(at);
    const double d = duration;
    at.x += d * (at.v + d * (acceleration / 2 + d * jerk / 6));
    at.v = std::max(at.v + d * (acceleration + d * jerk / 2), 0.0);
    at.t += d;
  };
  // From the middle of cell k − 1 to the middle of cell k, over the ramp at node k.
  for (std::size_t k = 0; k <= n; ++k) {
    const double before = k > 0 ? law.time[k - 1] : w.start.from_rest ? 0 : w.start.time;
    const double after = k < n ? law.time[k] : 0;
    const double u0 = k > 0 ? law.u[k - 1] : w.start.from_rest ? 0 : w.start.u;
    const double u1 = k < n ? law.u[k] : 0;
    const bool edge = !(before > 0) || !(after > 0);
    const double ramp = edge ? before + after : std::min(before, after);
    const Cause left = plan.cause[k > 0 ? k - 1 : 0], right = plan.cause[k < n ? k : n - 1];
    if (!edge) go((before - ramp) / 2, 0, u0, left);
    law.node_time[k] = at.t + ramp / 2;
    go(ramp, (u1 - u0) / ramp, u0, left);
    if (!edge) go((after - ramp) / 2, 0, u1, right);
  }
  take_drift_back(w, law.knots, plan.x.back() - at.x, -at.v, at.t);
  law.knots.push_back({at.t, plan.x.back(), 0, 0, 0, {}});
  return law;
}

void slow_down(NodePlan& plan, WindowLaw& law, double factor) {
  slow_down(law.knots, factor);
  const double t0 = law.knots.front().t, square = factor * factor;
  for (double& t : law.node_time) t = t0 + factor * (t - t0);
  for (double& t : law.time) t *= factor;
  for (double& u : law.u) u /= square;
  for (double& b : plan.b) b /= square;
  for (double& q : plan.q) q /= square;
}

}  // namespace aircut::plan
