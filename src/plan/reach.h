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

/// A box of tips that is proven to be reachable on the branch where the joints are. Pieces inside
/// need no proof of their own; it is larger than the piece that asked for it, for those that
/// follow.
class ProvenBox {
 public:
  bool holds(const machine::TipInterval& tip) const;
  /// Tries a box around `tip`, which has its tool offset and joints.
  bool widen(const machine::Kinematics& kinematics, const machine::TipInterval& tip,
             std::span<double> scratch);
  /// The joints are on another branch, or the kinematics is another one.
  void forget() { known_ = false; }

 private:
  bool known_ = false;
  machine::TipInterval box_;
  double margin_ = 2;  ///< mm; a hundredth of it in rad
};

/// The first place of the piece that can't be reached. `near`: joints at its start. `scratch` has
/// room for all driven joints and passive values.
/// `proven`: what is known from the pieces before.
std::optional<ReachLimit> find_reach_limit(const machine::Kinematics& kinematics, const Path& path,
                                           const AxisValues& tool_offset,
                                           const machine::JointVector& near,
                                           std::span<double> scratch, ProvenBox& proven);

}  // namespace aircut::plan
