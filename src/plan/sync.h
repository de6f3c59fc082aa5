// Private: the time law of motion that is synchronised to a spindle.
#pragma once

#include <optional>

#include "plan/s_curve.h"

namespace aircut::plan {

struct SyncLaw {
  SpeedProfile lock;    ///< from rest until the way left is just that of the stop
  SpeedProfile stop;    ///< from the spindle's speed to rest; its s starts at 0
  double lock_way = 0;  ///< way until the axis is where the spindle wants it, mm
};

/// A way of `length` at `speed`, wanted from the first moment on. Nothing when the axis can't be
/// that fast, or the way is too short to catch up.
std::optional<SyncLaw> sync_law(double length, double speed, const StraightLimits& limits);

}  // namespace aircut::plan
