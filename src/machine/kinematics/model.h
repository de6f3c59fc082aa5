// A kinematics from a model: the model gives its closed-form inverse once, for any number type, and
// its forward solution; from these come joints, passive values, rates and travel bounds.
//
// Travel bounds are those of slope_bound.h. A path without a singular pose stays in its branch, so
// the bound for the branch of `near` holds. A model may put guards behind its values: numbers that
// have a bound only where the pose keeps clear of places that the inverse alone does not see (for
// example where the platform of a parallel machine could fall to the other side).
//
// The branch is kept from `near`: no target makes a machine jump into another configuration. Angles
// are given in the turn that is nearest to `near`.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "machine/kinematics/kinematics_table.h"
#include "machine/kinematics/slope_bound.h"
#include "machine/kinematics/vectors.h"

namespace aircut::machine {

/// What most models have in common; a model replaces what differs in it.
struct BasicModel {
  using Branch = int;  ///< which of several solutions
  static constexpr int passives = 0, guards = 0;
  static constexpr std::array<int, 1> branches() { return {0}; }
  int branch_of(const JointVector&) const { return 0; }
  bool rotary(int /*joint*/) const { return false; }
  /// Joints that depend on the turns in which others are.
  void settle(const PoseWords<double>& /*tip*/, JointVector& /*joints*/) const {}
  /// As Kinematics::couple().
  void couple(JointVector& /*joints*/) const {}
  std::vector<std::string> passive_names() const { return {}; }
  int passive_count() const { return 0; }
  std::optional<Vec3> tool_axis(const AxisValues&) const { return std::nullopt; }
  /// Tools have lengths along X, Y and Z.
  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    return wrong_offset_beyond(offset, 3, "tools have lengths along X, Y and Z");
  }

 protected:
  static std::optional<std::string> wrong_offset_beyond(const AxisValues& offset, std::size_t first,
                                                        const char* possible) {
    for (const Axis axis : all_axes)
      if (index(axis) >= first && offset[axis] != 0)
        return std::string("a tool offset in ") + letter(axis) +
               " is not possible on this machine: " + possible;
    return std::nullopt;
  }
  /// For types whose tools are along the spindle.
  static std::optional<std::string> wrong_offset_but_z(AxisValues offset) {
    offset[Axis::z] = 0;
    return wrong_offset_beyond(offset, 0, "tools are along the spindle (Z)");
  }
};

/// A model has, beside the names of BasicModel:
///   static constexpr int joints
///   std::string_view type() const, AxisSet axes() const
///   std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, branch)
///   template <class T> std::array<T, joints + passives + guards>
///       solve(const PoseWords<T>& tip, const Vec3& tool, branch) const
///   tl::expected<AxisValues, ReachError> forward(const JointVector&, const Vec3& tool) const
/// and beside why_not() or in its place it may have that and solve<double>() in one, which needs to
/// give the joints alone:
///   std::optional<std::string> solve_checked(const PoseWords<double>& tip, const Vec3& tool,
///                                            branch, std::array<double, …>& q) const
template <class Model>
class ModelKinematics final : public Kinematics {
 public:
  explicit ModelKinematics(const Model& model) : model_(model) {}

  std::string_view type() const override { return model_.type(); }
  AxisSet axes() const override { return model_.axes(); }
  int joint_count() const override { return Model::joints; }
  std::vector<std::string> passive_names() const override { return model_.passive_names(); }
  int passive_count() const override { return model_.passive_count(); }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector& near) const override {
    if (const auto error = model_.wrong_offset(target.tool_offset))
      return unexpected(ReachError{*error});
    const PoseWords<double> pose = words_of(target.tip);
    const Vec3 tool = tool_of(target.tool_offset);
    const auto branch = model_.branch_of(near);
    for (const double word : pose)
      if (!std::isfinite(word)) return unexpected(ReachError{"the pose is no number"});
    Solved q;
    if (auto error = checked(pose, tool, branch, q))
      return unexpected(ReachError{std::move(*error)});
    JointVector joints(Model::joints);
    constexpr double turn = 2 * std::numbers::pi;
    for (int j = 0; j < Model::joints; ++j) {
      const double value = q[static_cast<std::size_t>(j)];
      joints[j] = model_.rotary(j) ? value + turn * std::round((near[j] - value) / turn) : value;
      if (!std::isfinite(joints[j])) return unexpected(ReachError{"the pose is no number"});
    }
    model_.settle(pose, joints);
    return joints;
  }

  void couple(JointVector& joints) const override { model_.couple(joints); }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    if (const auto error = model_.wrong_offset(tool_offset)) return unexpected(ReachError{*error});
    return model_.forward(joints, tool_of(tool_offset));
  }

  std::optional<Vec3> tool_axis(const AxisValues& tip) const override {
    return model_.tool_axis(tip);
  }

  // Where the joints can't be assembled the parts are drawn as they are at zero; forward() tells
  // that this is no position of the machine.
  void passive(const JointVector& joints, std::span<double> out) const override {
    std::fill(out.begin(), out.end(), 0.0);
    if constexpr (Model::passives > 0) {
      const auto tip = model_.forward(joints, Vec3::Zero());
      if (!tip) return;
      const auto q =
          model_.template solve<double>(words_of(*tip), Vec3::Zero(), model_.branch_of(joints));
      const auto count = std::min(out.size(), static_cast<std::size_t>(Model::passives));
      std::copy_n(q.begin() + Model::joints, count, out.begin());
    }
  }

  bool rates(const Target& target, const JointVector& joints, const AxisValues& d_tip,
             const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const override {
    const Vec3 tool = tool_of(target.tool_offset);
    const auto branch = model_.branch_of(joints);
    if (model_.wrong_offset(target.tool_offset) || why_not(words_of(target.tip), tool, branch))
      return false;
    PoseWords<Jet> pose;
    for (std::size_t i = 0; i < pose.size(); ++i)
      pose[i] = {target.tip[all_axes[i]], d_tip[all_axes[i]], dd_tip[all_axes[i]]};
    const auto q = model_.template solve<Jet>(pose, tool, branch);
    dq.resize(Model::joints);
    ddq.resize(Model::joints);
    for (Eigen::Index j = 0; j < Model::joints; ++j) {
      dq[j] = q[static_cast<std::size_t>(j)].d;
      ddq[j] = q[static_cast<std::size_t>(j)].dd;
    }
    return true;
  }

  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    if (model_.wrong_offset(tip.tool_offset)) return false;
    PoseWords<Interval> box;
    PoseWords<double> way{};
    for (std::size_t i = 0; i < box.size(); ++i) {
      box[i] = {tip.low[all_axes[i]], tip.high[all_axes[i]]};
      way[i] = tip.travel[all_axes[i]];
      if (!box[i].finite()) return false;
    }
    const auto used = static_cast<std::size_t>(Model::joints + model_.passive_count());
    std::array<double, values> most{};
    static constexpr auto all = Model::branches();
    using Branch = typename Model::Branch;
    const Branch one = tip.near.size() > 0 ? model_.branch_of(tip.near) : all[0];
    const std::span<const Branch> branches =
        tip.near.size() > 0 ? std::span<const Branch>(&one, 1) : std::span<const Branch>(all);
    const Vec3 tool = tool_of(tip.tool_offset);
    const bool good = std::all_of(branches.begin(), branches.end(), [&](const Branch& branch) {
      return raise_travel(box, way, splits, most, [&](const PoseWords<Slope>& pose) {
        return model_.template solve<Slope>(pose, tool, branch);
      });
    });
    if (good) std::copy_n(most.begin(), used, travel.begin());
    return good;
  }

 private:
  static constexpr int splits = 9;
  static constexpr std::size_t values =
      static_cast<std::size_t>(Model::joints + Model::passives + Model::guards);

  using Solved = decltype(std::declval<const Model&>().template solve<double>(
      PoseWords<double>{}, Vec3{}, typename Model::Branch{}));

  /// Why there is no solution, or the solution's joints. A model whose check has the parts of its
  /// solution at hand has both in one, `solve_checked`.
  template <class Branch>
  std::optional<std::string> checked(const PoseWords<double>& pose, const Vec3& tool,
                                     const Branch& branch, Solved& q) const {
    if constexpr (requires { model_.solve_checked(pose, tool, branch, q); }) {
      return model_.solve_checked(pose, tool, branch, q);
    } else {
      auto error = model_.why_not(pose, tool, branch);
      if (!error) q = model_.template solve<double>(pose, tool, branch);
      return error;
    }
  }

  template <class Branch>
  std::optional<std::string> why_not(const PoseWords<double>& pose, const Vec3& tool,
                                     const Branch& branch) const {
    if constexpr (requires { model_.why_not(pose, tool, branch); }) {
      return model_.why_not(pose, tool, branch);
    } else {
      Solved q;
      return model_.solve_checked(pose, tool, branch, q);
    }
  }

  static PoseWords<double> words_of(const AxisValues& tip) {
    PoseWords<double> pose;
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = tip[all_axes[i]];
    return pose;
  }
  static Vec3 tool_of(const AxisValues& offset) {
    return {offset[Axis::x], offset[Axis::y], offset[Axis::z]};
  }

  Model model_;
};

template <class Model>
std::shared_ptr<const Kinematics> make_model(const Model& model) {
  return std::make_shared<ModelKinematics<Model>>(model);
}

inline AxisSet axes_of(std::string_view letters) {
  AxisSet set;
  for (const char c : letters)
    if (const auto axis = axis_of_letter(c)) set.add(*axis);
  return set;
}

}  // namespace aircut::machine
