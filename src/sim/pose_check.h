// Whether bodies of the machine touch in a position, without a motion: for workspaces.
#pragma once

#include <optional>
#include <string>

#include "sim/sim.h"

namespace aircut::sim {

/// Looks at all pairs of bodies that a run watches, with the tool that is in the spindle of the
/// scene. Thread-safe.
class PoseCheck {
 public:
  /// Pairs that overlap at `home` are left out: they are told by `machine check`.
  PoseCheck(Scene scene, const JointVector& home);
  ~PoseCheck();
  PoseCheck(const PoseCheck&) = delete;
  PoseCheck& operator=(const PoseCheck&) = delete;

  /// True when no two bodies overlap.
  bool is_free(const JointVector& joints) const;
  std::size_t pairs() const;
  /// Of the pairs that are left out: "head – table".
  const std::vector<std::string>& left_out() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aircut::sim
