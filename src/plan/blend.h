// Private: rounding of corners (G64 P).
#pragma once

#include <functional>

#include "plan/geometry.h"

namespace aircut::plan {

/// A corner between the end of `left` and the start of `right`; both count F along XYZ.
struct CornerShape {
  const Path& left;
  const Path& right;
  double left_room = 0;  ///< how much of each may be cut off, along s
  double right_room = 0;
  double tolerance = 0;  ///< G64 P, mm; 0 = no limit
  /// The joints are linear in the tip: what a blend between lines demands goes exactly with 1 /
  /// size.
  bool linear_joints = false;
};

struct CornerBlend {
  Blend blend;
  double cut = 0;  ///< taken off each side, along s
};

/// How large the acceleration on a blend would be at the wanted speed, as a share of the limits.
using Demand = std::function<double(const Blend&)>;

/// The blend, no rounder than `demand` asks for; nothing where the corner must be a stop.
std::optional<CornerBlend> make_blend(const CornerShape& corner, const Demand& demand);

}  // namespace aircut::plan
