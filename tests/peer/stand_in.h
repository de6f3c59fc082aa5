// Where rs274's stand-in for a machine ends a probing move: a hundredth of an inch in front of the
// target, or behind it when the way is shorter than that.
#pragma once

#include <optional>

#include "interp/interp.h"

namespace aircut::test {

/// Follows a stream of commands as the stand-in does. It measures the way from where it believes
/// the tool to be, which neither rotations nor tool length offsets change.
class StandInProbe {
 public:
  /// To be called with each command in turn; says where a probing move ends.
  std::optional<interp::ProbeHit> follow(const canon::Command& command);

 private:
  AxisValues program_of(const AxisValues& tip) const;
  AxisValues tip_of(const AxisValues& program) const;
  interp::ProbeHit probe(const AxisValues& target);

  AxisValues work_, g92_;
  double rotation_ = 0;
  AxisValues believed_;  ///< where it takes the tool to be, program coordinates
  AxisValues tip_;       ///< where the tool is
};

}  // namespace aircut::test
