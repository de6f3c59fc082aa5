#include "machine/machine.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace aircut::machine {

std::string_view to_string(Role role) {
  switch (role) {
    case Role::machine:
      return "machine";
    case Role::spindle:
      return "spindle";
    case Role::holder:
      return "holder";
    case Role::shank:
      return "shank";
    case Role::cutter:
      return "cutter";
    case Role::fixture:
      return "fixture";
    case Role::stock:
      return "stock";
    case Role::part:
      return "part";
    case Role::probe:
      return "probe";
  }
  return "machine";
}

void Kinematics::couple(JointVector&) const {}

void Kinematics::passive(const JointVector&, std::span<double> out) const {
  assert(passive_names().empty() && "a kinematics with passive values must compute them");
  std::fill(out.begin(), out.end(), 0.0);
}

bool Kinematics::rates(const Target&, const JointVector&, const AxisValues&, const AxisValues&,
                       JointVector&, JointVector&) const {
  return false;
}

JointVector Machine::home() const {
  JointVector joints(joint_count());
  for (int i = 0; i < joint_count(); ++i) joints[i] = joint(JointId{i}).home;
  return joints;
}

int Machine::model() const {
  for (std::size_t i = 0; i < models_.size(); ++i)
    if (models_[i].channel == channel_) return static_cast<int>(i);
  return 0;
}

std::optional<LinkId> Machine::find_link(const std::string& name) const {
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].name == name) return LinkId{static_cast<int>(i)};
  return std::nullopt;
}

namespace {

// E(q): pose of the child seen from where it is at q = 0, both in bed axes (kinematics.md a.2).
Pose couple_pose(const Joint& joint, double q) {
  Pose E = Pose::Identity();
  if (joint.kind == JointKind::linear) {
    E.translation() = joint.sense * q * joint.direction;
  } else {
    E.linear() = Eigen::AngleAxisd(joint.sense * q, joint.direction).toRotationMatrix();
    E.translation() = joint.origin - E.linear() * joint.origin;
  }
  return E;
}

std::size_t passive_index(const Machine& machine, const Joint& joint) {
  if (joint.passive_index >= 0) return static_cast<std::size_t>(joint.passive_index);
  const std::vector<std::string> names = machine.kinematics().passive_names();
  const auto found = std::find(names.begin(), names.end(), joint.passive);
  assert(found != names.end() && "the kinematics has a value for every passive couple");
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

void forward(const Machine& machine, const JointVector& joints, LinkPoses& out) {
  constexpr std::size_t max_passive = 32;
  std::array<double, max_passive> passive{};
  const bool more_couples = machine.tree().size() > static_cast<std::size_t>(machine.joint_count());
  const auto count =
      more_couples ? static_cast<std::size_t>(machine.kinematics().passive_count()) : 0;
  if (count > 0) {
    assert(count <= max_passive);
    machine.kinematics().passive(joints, std::span(passive).first(count));
  }
  out.X_WL.resize(machine.links().size());
  out.X_WL[0] = Pose::Identity();
  for (const Joint& joint : machine.tree()) {  // parents come before children
    const double q = joint.driven >= 0 ? joints[joint.driven]
                     : joint.held      ? joint.home
                                       : passive[passive_index(machine, joint)];
    out.X_WL[static_cast<std::size_t>(index(joint.child))] =
        out.X_WL[static_cast<std::size_t>(index(joint.parent))] * couple_pose(joint, q);
  }
}

}  // namespace aircut::machine
