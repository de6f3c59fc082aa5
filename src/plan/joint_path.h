// Private: the joints along a path piece, q(s), with q' and q'' by s.
#pragma once

#include "plan/plan.h"

namespace aircut::plan {

/// q(s) of one piece. Borrows the kinematics for its life.
class JointPath {
 public:
  JointPath(const machine::Kinematics& kinematics, const Path& path, const AxisValues& tool_offset)
      : kinematics_(&kinematics), path_(&path), tool_offset_(tool_offset) {}

  /// Joints at s; `near` chooses the branch.
  tl::expected<machine::JointVector, machine::ReachError> joints(
      double s, const machine::JointVector& near) const;
  /// Joints with derivatives at a point of the path; the error also says when they are not finite
  /// (a singular pose).
  std::optional<machine::ReachError> point(const PathPoint& p, const machine::JointVector& near,
                                           JointPoint& out) const;
  const Path& path() const { return *path_; }
  const AxisValues& tool_offset() const { return tool_offset_; }

 private:
  const machine::Kinematics* kinematics_;
  const Path* path_;
  AxisValues tool_offset_;
};

}  // namespace aircut::plan
