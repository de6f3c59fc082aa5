// Private: proof that a whole piece of path can be reached.
#pragma once

#include <span>

#include "plan/geometry.h"

namespace aircut::plan {

struct ReachLimit {
  double good = 0;     ///< last s that is known to be good
  double bad = 0;      ///< s that can't be reached, at most 1e-6 of the piece later
  std::string reason;  ///< what is missing in the middle of the stretch that can't be reached
};

/// The first place of the piece that can't be reached. `near`: joints at its start. `scratch` has
/// room for all driven joints and passive values.
std::optional<ReachLimit> find_reach_limit(const machine::Kinematics& kinematics, const Path& path,
                                           const AxisValues& tool_offset,
                                           const machine::JointVector& near,
                                           std::span<double> scratch);

}  // namespace aircut::plan
