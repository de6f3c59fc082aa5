// What the three robots have in common: arm lengths, branches, the tool's direction.
//
// A tool of length L (only Z of the tool offset is possible: the tool turns with the flange) moves
// the tip by −L·k, k the tool's direction: what the inverse gets is dt + L or at + L.
#pragma once

#include "machine/kinematics/model.h"

namespace aircut::machine {

template <class T>
using RobotPose = PoseWords<T>;
template <class T>
using RobotJoints = std::array<T, 6>;

/// Which of the solutions: shoulder front (+1) or rear, elbow, wrist.
struct RobotBranch {
  double shoulder = 1, elbow = 1, wrist = 1;
};

// A singular pose is one whose factor of det J is below this (mm, or no unit).
inline constexpr double robot_singular = 1e-6;

/// k in M for the tool direction angles: Rx(A)·Ry(B)·(0, 0, 1).
inline Vec3 tool_direction(double a, double b) {
  return {std::sin(b), -std::sin(a) * std::cos(b), std::cos(a) * std::cos(b)};
}

/// Tip of a tool on the gauge face X_MF: A and B by the tool's direction, C when there is one.
inline AxisValues robot_tip(const Pose& X_MF, const Vec3& tool, bool with_c) {
  const Mat3& R = X_MF.linear();
  const Vec3 p = X_MF.translation() - tool.z() * R.col(2);
  AxisValues tip;
  tip[Axis::x] = p.x();
  tip[Axis::y] = p.y();
  tip[Axis::z] = p.z();
  tip[Axis::a] = std::atan2(-R(1, 2), R(2, 2));
  tip[Axis::b] = std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2)));
  if (with_c) tip[Axis::c] = std::atan2(-R(0, 1), R(0, 0));
  return tip;
}

struct RobotModel : BasicModel {
  using Branch = RobotBranch;
  RobotArm p;

  bool rotary(int) const { return true; }
  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    return wrong_offset_but_z(offset);
  }
  std::optional<Vec3> tool_axis(const AxisValues& tip) const {
    return tool_direction(tip[Axis::a], tip[Axis::b]);
  }
};

/// A key of `[kinematics]` and the length that it gives.
struct RobotKey {
  const char* key;
  double RobotArm::*length;
  bool positive;
};

/// Reads lengths of the arm that are given; the others keep their defaults. False after an error.
bool read_robot_arm(KinematicsInput& input, std::string_view type, int joints,
                    std::span<const RobotKey> keys, RobotArm& arm);

}  // namespace aircut::machine
