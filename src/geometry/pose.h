// A pose carries its two frames in its name: X_WT is frame T seen from W (docs/architecture.md).
#pragma once

#include <Eigen/Geometry>

namespace aircut {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;
using Box3 = Eigen::AlignedBox3d;

/// A pose that only shifts, mm.
inline Pose translation(const Vec3& p) {
  Pose X = Pose::Identity();
  X.translation() = p;
  return X;
}

}  // namespace aircut
