// Private: what passing a blend asks of the joints.
#pragma once

#include "plan/blend.h"
#include "plan/grid.h"
#include "plan/s_curve.h"

namespace aircut::plan {

struct CornerLoad {
  bool known = false;       ///< false when a place of it can't be reached
  double speed = 0;         ///< wanted path speed: the feed, or what the joints' speeds allow
  double acceleration = 0;  ///< largest share of an acceleration limit at that steady speed
  double jerk = 0;          ///< and of a jerk limit
  StraightLimits along{};   ///< limits of path speed, acceleration and jerk on the sides

  /// How much too small the blend is for the wanted speed; above 1 the speed must drop. Linear in
  /// 1 / size: the third derivative goes with the square of the size.
  double demand() const;
};

CornerLoad load_of(const machine::Kinematics& kinematics, const Blend& blend, double feed,
                   const AxisValues& tool_offset, const JointLimits& limits,
                   const machine::JointVector& near);

/// The same between two lines on a machine whose joints are linear in the tip. `in`, `out`: the
/// joints' derivatives by the XYZ length of each line, `turn_cosine`: of the angle between them.
CornerLoad load_of_lines(const CornerRates& rates, double cut, const machine::JointVector& in,
                         const machine::JointVector& out, double turn_cosine, double feed,
                         const JointLimits& limits);

/// True when coming to rest in the corner takes less time than the blend. `cut` is what the blend
/// takes off each side, `shorter` the shorter side. Only asked under jerk limits: without them a
/// blend always gains.
bool stop_is_faster(const CornerLoad& load, const Blend& blend, double cut, double shorter);

}  // namespace aircut::plan
