// A piece of a segment, cut out by time.
#pragma once

#include <optional>

#include "plan/plan.h"

namespace aircut::plan {

/// What happens of a segment between two program times within it, as a segment of its own: the same
/// way at the same times. Nothing for a rapid whose joints have time laws of their own (dogleg).
std::optional<Segment> part_of(const Segment& segment, double ta, double tb);

}  // namespace aircut::plan
