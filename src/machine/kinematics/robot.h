// What the three robots have in common. A model gives its closed-form inverse once, for any number
// type, and its forward solution; from these come joints, rates and travel bounds.
//
// Travel bounds are those of slope_bound.h. A path without a singular pose stays in its branch, so
// the bound for the branch of `near` holds; the wrist's two sides have the same slopes.
//
// The shoulder's and the elbow's side are kept from `near`: no target makes the arm jump into
// another configuration. Angles are given in the turn that is nearest to `near`.
//
// A tool of length L (only Z of the tool offset is possible: the tool turns with the flange) moves
// the tip by −L·k, k the tool's direction: what the inverse gets is dt + L or at + L.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/kinematics/kinematics_table.h"
#include "machine/kinematics/slope_bound.h"

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

/// The six pose words and their solution for one model, as the interface wants them.
template <class Model>
class RobotKinematics final : public Kinematics {
 public:
  explicit RobotKinematics(const RobotArm& arm) : model_{arm} {}

  std::string_view type() const override { return Model::type; }
  AxisSet axes() const override {
    AxisSet set;
    for (const Axis axis : pose_axes())
      if (Model::joints == 6 || axis != Axis::c) set.add(axis);
    return set;
  }
  int joint_count() const override { return Model::joints; }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector& near) const override {
    if (const auto error = wrong_offset(target.tool_offset)) return unexpected(ReachError{*error});
    const RobotPose<double> pose = pose_of(target.tip);
    const double length = target.tool_offset[Axis::z];
    const RobotBranch branch = model_.branch_of(near);
    if (const auto error = model_.why_not(pose, length, branch))
      return unexpected(ReachError{*error});
    const RobotJoints<double> q = model_.template solve<double>(pose, length, branch);
    JointVector joints(Model::joints);
    constexpr double turn = 2 * std::numbers::pi;
    for (Eigen::Index j = 0; j < Model::joints; ++j) {
      const double value = q[static_cast<std::size_t>(j)];
      joints[j] = value + turn * std::round((near[j] - value) / turn);
      if (!std::isfinite(joints[j])) return unexpected(ReachError{"the pose is no number"});
    }
    return joints;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    if (const auto error = wrong_offset(tool_offset)) return unexpected(ReachError{*error});
    if (const auto error = model_.why_not_joints(joints)) return unexpected(ReachError{*error});
    const Pose X_MF = model_.gauge(joints);
    const Mat3& R = X_MF.linear();
    const Vec3 p = X_MF.translation() - tool_offset[Axis::z] * R.col(2);
    AxisValues tip;
    tip[Axis::x] = p.x();
    tip[Axis::y] = p.y();
    tip[Axis::z] = p.z();
    tip[Axis::a] = std::atan2(-R(1, 2), R(2, 2));
    tip[Axis::b] = std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2)));
    if (Model::joints == 6) tip[Axis::c] = std::atan2(-R(0, 1), R(0, 0));
    return tip;
  }

  std::optional<Vec3> tool_axis(const AxisValues& tip) const override {
    return tool_direction(tip[Axis::a], tip[Axis::b]);
  }

  bool rates(const Target& target, const JointVector& joints, const AxisValues& d_tip,
             const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const override {
    const double length = target.tool_offset[Axis::z];
    const RobotBranch branch = model_.branch_of(joints);
    if (wrong_offset(target.tool_offset) || model_.why_not(pose_of(target.tip), length, branch))
      return false;
    RobotPose<Jet> pose;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const Axis axis = pose_axes()[i];
      pose[i] = {target.tip[axis], d_tip[axis], dd_tip[axis]};
    }
    const RobotJoints<Jet> q = model_.template solve<Jet>(pose, length, branch);
    dq.resize(Model::joints);
    ddq.resize(Model::joints);
    for (Eigen::Index j = 0; j < Model::joints; ++j) {
      dq[j] = q[static_cast<std::size_t>(j)].d;
      ddq[j] = q[static_cast<std::size_t>(j)].dd;
    }
    return true;
  }

  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    if (wrong_offset(tip.tool_offset)) return false;
    RobotPose<Interval> box;
    RobotPose<double> way{};
    for (std::size_t i = 0; i < box.size(); ++i) {
      const Axis axis = pose_axes()[i];
      box[i] = {tip.low[axis], tip.high[axis]};
      way[i] = tip.travel[axis];
      if (!box[i].finite()) return false;
    }
    std::fill_n(travel.begin(), Model::joints, 0.0);
    static constexpr auto all = Model::branches();
    const RobotBranch one = tip.near.size() > 0 ? model_.branch_of(tip.near) : RobotBranch{};
    const std::span<const RobotBranch> branches =
        tip.near.size() > 0 ? std::span<const RobotBranch>(&one, 1) : all;
    const double length = tip.tool_offset[Axis::z];
    return std::all_of(branches.begin(), branches.end(), [&](const RobotBranch& branch) {
      return raise_travel(box, way, splits, travel.first(Model::joints),
                          [&](const RobotPose<Slope>& pose) {
                            return model_.template solve<Slope>(pose, length, branch);
                          });
    });
  }

 private:
  static constexpr int splits = 9;

  static const std::array<Axis, 6>& pose_axes() {
    static constexpr std::array<Axis, 6> axes = {Axis::x, Axis::y, Axis::z,
                                                 Axis::a, Axis::b, Axis::c};
    return axes;
  }
  RobotPose<double> pose_of(const AxisValues& tip) const {
    RobotPose<double> pose;
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = tip[pose_axes()[i]];
    return pose;
  }

  static std::optional<std::string> wrong_offset(const AxisValues& offset) {
    for (const Axis axis : all_axes)
      if (axis != Axis::z && offset[axis] != 0)
        return std::string("a tool offset in ") + letter(axis) +
               " is not possible on this machine: tools are along the spindle (Z)";
    return std::nullopt;
  }

  Model model_;
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
