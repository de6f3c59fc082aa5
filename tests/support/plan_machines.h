// Machines without meshes, and programs as lists of canonical commands, for tests of the planner,
// the motion and the joint log.
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "machine/machine.h"
#include "plan/plan.h"

namespace aircut::test {

inline constexpr double rad = std::numbers::pi / 180;

struct JointLimit {
  double v, a;  ///< mm or degrees for rotary joints
  double j = std::numeric_limits<double>::infinity();
};

inline void add_joint(machine::Machine& m, const std::string& name, bool rotary, JointLimit limit) {
  machine::Joint joint;
  joint.name = name;
  joint.kind = rotary ? machine::JointKind::rotary : machine::JointKind::linear;
  joint.vmax = limit.v * (rotary ? rad : 1);
  joint.amax = limit.a * (rotary ? rad : 1);
  joint.jmax = limit.j * (rotary ? rad : 1);
  joint.driven = static_cast<int>(m.driven_.size());
  m.driven_.push_back(static_cast<int>(m.tree_.size()));
  joint.child = machine::LinkId{static_cast<int>(m.links_.size())};
  m.links_.push_back({name, machine::bed_link, static_cast<int>(m.tree_.size())});
  m.tree_.push_back(joint);
}

/// Each letter is a joint with the limits at the same place.
inline std::shared_ptr<machine::Machine> identity_machine(const std::string& letters,
                                                          const std::vector<JointLimit>& limits) {
  auto m = std::make_shared<machine::Machine>();
  m->name_ = "test " + letters;
  std::vector<Axis> axes;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const Axis axis = *axis_of_letter(letters[i]);
    axes.push_back(axis);
    add_joint(*m, std::string(1, letters[i]), is_rotary(axis), limits[i]);
  }
  m->kinematics_ = machine::make_identity(axes);
  m->tool_change_.seconds = 3;
  return m;
}

/// X Y Z with 100 mm/s, 1000 mm/s² (Z half of both).
inline std::shared_ptr<machine::Machine> mill() {
  return identity_machine("XYZ", {{100, 1000}, {100, 1000}, {50, 500}});
}

/// The crossed O-X glide with its default lengths.
inline std::shared_ptr<machine::Machine> ox_machine(JointLimit limit = {500, 3000}) {
  auto m = std::make_shared<machine::Machine>();
  m->name_ = "test ox";
  for (const char* name : {"s1", "s2", "s3"}) add_joint(*m, name, false, limit);
  m->kinematics_ = machine::make_ox_glide({});
  return m;
}

inline AxisValues at(std::initializer_list<std::pair<Axis, double>> values) {
  AxisValues out;
  for (const auto& [axis, value] : values) out[axis] = value;
  return out;
}
inline AxisValues xyz(double x, double y, double z) {
  return at({{Axis::x, x}, {Axis::y, y}, {Axis::z, z}});
}

/// Commands with running block numbers.
class Program {
 public:
  Program& add(canon::Action action) {
    return add_at(static_cast<std::uint32_t>(commands_.size()) + 1, std::move(action));
  }
  Program& add_at(std::uint32_t block, canon::Action action) {
    canon::Command command;
    command.action = std::move(action);
    command.block = block;
    command.span.line = block;
    commands_.push_back(std::move(command));
    return *this;
  }
  Program& feed(double mm_per_s) { return add(canon::SetFeedRate{mm_per_s, mm_per_s * rad}); }
  Program& rapid(const AxisValues& end) { return add(canon::Rapid{end}); }
  Program& line(const AxisValues& end) { return add(canon::LinearFeed{end}); }
  Program& exact_stop() { return add(canon::SetPathMode{canon::PathMode::exact_stop, 0}); }
  Program& exact_path() { return add(canon::SetPathMode{canon::PathMode::exact_path, 0}); }
  Program& blend(double p) { return add(canon::SetPathMode{canon::PathMode::continuous, p}); }
  Program& merge(double q) { return add(canon::SetNaiveCam{q}); }
  Program& dwell(double seconds) { return add(canon::Dwell{seconds}); }
  /// Arc in the XY plane about (cx, cy).
  Program& arc(const AxisValues& end, double cx, double cy, int turns = 1) {
    return add(canon::ArcFeed{end, Vec3(cx, cy, 0), Vec3::UnitZ(), turns, canon::Plane::xy});
  }
  const std::vector<canon::Command>& commands() const { return commands_; }

 private:
  std::vector<canon::Command> commands_;
};

struct Planned {
  std::vector<plan::Segment> segments;
  std::vector<std::string> errors;
  double time() const { return segments.empty() ? 0 : segments.back().t_end(); }
};

inline Planned plan_program(const machine::Machine& machine, const machine::JointVector& start,
                            const Program& program, plan::Options options = {}) {
  Planned out;
  plan::Planner planner(machine, start, options);
  const auto drain = [&] {
    while (auto segment = planner.take()) out.segments.push_back(std::move(*segment));
  };
  for (const canon::Command& command : program.commands()) {
    if (auto done = planner.push(command); !done)
      out.errors.push_back(done.error().kind + ": " + done.error().message);
    drain();
  }
  planner.flush();
  drain();
  return out;
}

inline machine::JointVector zeros(const machine::Machine& machine) {
  return machine::JointVector::Zero(machine.joint_count());
}

/// Joints of a tip.
inline machine::JointVector joints_at(const machine::Machine& machine, const AxisValues& tip) {
  return *machine.kinematics().inverse({tip, {}}, zeros(machine));
}

}  // namespace aircut::test
