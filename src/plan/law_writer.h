// Private: a time law written phase by phase, each of constant jerk.
#pragma once

#include <cmath>

#include "plan/s_curve.h"

namespace aircut::plan {

/// Duration of a change of speed with no acceleration at both ends under a jerk limit; its way is
/// that time at the mean of both speeds.
inline double change_time(double change, const StraightLimits& limits) {
  return change >= limits.a * limits.a / limits.j ? change / limits.a + limits.a / limits.j
                                                  : 2 * std::sqrt(change / limits.j);
}

class LawWriter {
 public:
  LawWriter() = default;
  /// Goes on from a state.
  explicit LawWriter(const ProfileKnot& from) : at_(from) {}

  /// A change of speed, with acceleration zero at both ends under a jerk limit.
  void change(double v1, const StraightLimits& limits) {
    const double sense = v1 > at_.v ? 1 : -1, size = std::abs(v1 - at_.v);
    if (!(size > 0)) return;
    if (std::isinf(limits.j)) {
      go(size / limits.a, 0, sense * limits.a);
    } else {
      const bool holds = size > limits.a * limits.a / limits.j;
      const double rise = holds ? limits.a / limits.j : std::sqrt(size / limits.j);
      const double top = sense * rise * limits.j;
      go(rise, sense * limits.j, 0);
      if (holds) go(size / limits.a - limits.a / limits.j, 0, top);
      go(rise, -sense * limits.j, top);
    }
    at_.v = v1;
    at_.a = at_.j = 0;
  }
  /// Takes the acceleration back to none, at once without a jerk limit.
  void relax(const StraightLimits& limits) {
    const double a = at_.a;
    if (a != 0 && !std::isinf(limits.j))
      go(std::abs(a) / limits.j, a > 0 ? -limits.j : limits.j, a);
    at_.a = at_.j = 0;
  }
  void cruise(double seconds) { go(seconds, 0, 0); }

  double s() const { return at_.s; }
  double v() const { return at_.v; }
  /// The last knot is at s.
  SpeedProfile finish(double s) {
    profile_.knots.push_back({at_.t, s, at_.v, 0, 0});
    return std::move(profile_);
  }

 private:
  void go(double d, double jerk, double acceleration) {
    if (!(d > 0)) return;
    at_.a = acceleration;
    at_.j = jerk;
    profile_.knots.push_back(at_);
    at_.s += d * (at_.v + d * (acceleration / 2 + d * jerk / 6));
    at_.v += d * (acceleration + d * jerk / 2);
    at_.t += d;
  }
  SpeedProfile profile_;
  ProfileKnot at_;
};

}  // namespace aircut::plan
