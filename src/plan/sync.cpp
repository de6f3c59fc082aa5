// The spindle turns on while the axis still starts, so the axis is late by d. It overtakes: up to a
// peak p above the spindle's speed v, then down to v at the very moment when the lag is zero. With
// t(D) the time of a change of speed by D (rest of acceleration at both ends, so its mean speed is
// that of its middle):
//
//   p/2 t(p) + (p + v)/2 t(p − v) = v (t(p) + t(p − v))
//
// Left minus right is (p/2 − v) t(p) + (p − v)/2 t(p − v): it grows with p, so the peak is
// bisected. (Without a jerk limit p = (1 + 1/√2) v.) Where p is above the axis' speed, the axis
// keeps its top speed until the rest of the lag is gone.
#include "plan/sync.h"

#include <algorithm>
#include <cmath>

#include "plan/law_writer.h"

namespace aircut::plan {

std::optional<SyncLaw> sync_law(double length, double speed, const StraightLimits& limits) {
  const auto gain = [&](double peak) {
    return (peak / 2 - speed) * change_time(peak, limits) +
           (peak - speed) / 2 * change_time(peak - speed, limits);
  };
  constexpr double margin = 1.01;  // of speed: with less the axis never catches up
  if (!(limits.v > margin * speed)) return std::nullopt;
  double low = speed, high = std::min(2 * speed, limits.v);
  const bool capped = gain(high) < 0;
  for (int i = 0; i < 200 && !capped && high - low > 1e-15 * high; ++i) {
    const double middle = (low + high) / 2;
    (gain(middle) < 0 ? low : high) = middle;
  }
  LawWriter lock;
  lock.change(high, limits);
  if (capped) lock.cruise(-gain(high) / (high - speed));
  lock.change(speed, limits);
  SyncLaw out;
  out.lock_way = lock.s();
  const double stop_way = speed / 2 * change_time(speed, limits);
  const double rest = length - lock.s() - stop_way;
  if (rest < 0) return std::nullopt;
  lock.cruise(rest / speed);
  out.lock = lock.finish(length - stop_way);
  LawWriter stop(ProfileKnot{0, 0, speed, 0, 0});
  stop.change(0, limits);
  out.stop = stop.finish(stop_way);
  return out;
}

}  // namespace aircut::plan
