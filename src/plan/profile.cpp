// Evaluation of s(t): a search for the knot, then its polynomial; and of the spindle with it.
#include <algorithm>

#include "plan/plan.h"

namespace aircut::plan {

SpeedProfile::State SpeedProfile::at(double t) const {
  if (knots.empty()) return {};
  const ProfileKnot& last = knots.back();
  if (t >= last.t) return {last.s, last.v, last.a};
  const auto after = std::upper_bound(knots.begin(), knots.end(), t,
                                      [](double time, const ProfileKnot& k) { return time < k.t; });
  if (after == knots.begin()) {
    const ProfileKnot& first = knots.front();
    return {first.s, first.v, first.a};
  }
  const ProfileKnot& k = *(after - 1);
  const double tau = t - k.t;
  const double s = k.s + tau * (k.v + tau * (k.a / 2 + tau * k.j / 6));
  // Rounding must not carry s past the next knot: s never runs backwards.
  return {std::clamp(s, k.s, after->s), k.v + tau * (k.a + tau * k.j / 2), k.a + tau * k.j};
}

double spindle_turns(const Segment& segment, double t) {
  if (segment.sync && segment.sync->spindle_follows)
    return segment.sync->sense * segment.profile.at(t).s / segment.sync->pitch;
  if (segment.spindle_from) {
    // The integral of a speed that changes evenly.
    return (*segment.spindle_from + spindle_rpm(segment, t)) / 2 / 60 * t;
  }
  return segment.spindle_rpm / 60 * t;
}

double spindle_rpm(const Segment& segment, double t) {
  if (segment.sync && segment.sync->spindle_follows)
    return segment.sync->sense * segment.profile.at(t).v / segment.sync->pitch * 60;
  if (segment.spindle_from && segment.duration() > 0) {
    const double from = *segment.spindle_from;
    return from + (segment.spindle_rpm - from) * std::clamp(t / segment.duration(), 0.0, 1.0);
  }
  return segment.spindle_rpm;
}

}  // namespace aircut::plan
