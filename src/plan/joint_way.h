// Private: rapids that are straight in the joints, or doglegs, under overrides.
#pragma once

#include "plan/grid.h"
#include "plan/override.h"
#include "plan/s_curve.h"

namespace aircut::plan {

/// What the events do to a rapid (JointWay) that begins at rest at program time `now`. Takes the
/// events up to its end.
void override_joint_way(Segment& segment, const JointLimits& limits, Overrides& overrides,
                        double now);
/// Limits of a straight way of `length` on which joint j goes change[j].
StraightLimits limits_along(const JointLimits& limits, const machine::JointVector& change,
                            double length);

}  // namespace aircut::plan
