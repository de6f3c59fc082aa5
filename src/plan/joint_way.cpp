// Rapids that are straight in the joints, not in the program's axes.
//
//   joint    all joints start and end together: q = q0 + (q1 − q0) · way / length, and the whole
//            has the closed form of a straight move under the joints' limits
//   dogleg   every joint goes by its own closed form, as fast as it can; the slowest one says when
//            all are there, the others wait for it
//
// Both rest at their ends. The path's parameter s counts along the straight way between the ends,
// so that it is in mm as everywhere; in a dogleg it runs evenly with time. A joint never turns
// back, so its way between two places is the difference of its values there: an exact bound.
#include "plan/joint_way.h"

#include <algorithm>
#include <cmath>

#include "plan/geometry.h"
#include "plan/s_curve.h"

namespace aircut::plan {
JointLimits limits_of(const machine::Machine& machine) {
  const int n = machine.joint_count();
  JointLimits out{machine::JointVector(n), machine::JointVector(n), machine::JointVector(n),
                  machine.tip_acceleration()};
  for (int j = 0; j < n; ++j) {
    out.v[j] = machine.joint(machine::JointId{j}).vmax;
    out.a[j] = machine.joint(machine::JointId{j}).amax;
    out.j[j] = machine.joint(machine::JointId{j}).jmax;
  }
  return out;
}

JointPoint joint_point(const JointWay& way, double s) {
  const machine::JointVector change = way.to - way.from;
  const double f = std::clamp(s / way.length, 0.0, 1.0);
  JointPoint out;
  if (way.laws.empty()) {
    out.q = f < 1 ? machine::JointVector(way.from + f * change) : way.to;
    out.dq = change / way.length;
    out.ddq = machine::JointVector::Zero(change.size());
    return out;
  }
  out = {way.from, machine::JointVector::Zero(change.size()),
         machine::JointVector::Zero(change.size())};
  const double speed = way.length / way.seconds;
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    const SpeedProfile& law = way.laws[static_cast<std::size_t>(j)];
    if (law.knots.empty()) continue;
    const double sense = change[j] > 0 ? 1 : -1;
    const SpeedProfile::State state = law.at(f * way.seconds);
    out.q[j] = f < 1 ? way.from[j] + sense * state.s : way.to[j];
    out.dq[j] = sense * state.v / speed;
    out.ddq[j] = sense * state.a / (speed * speed);
  }
  return out;
}

tl::expected<JointRapid, machine::ReachError> joint_rapid(const machine::Machine& machine,
                                                          const machine::Kinematics& kinematics,
                                                          const machine::JointVector& from,
                                                          const AxisValues& start,
                                                          const AxisValues& end,
                                                          const AxisValues& tool_offset) {
  auto to = kinematics.inverse({end, tool_offset}, from);
  if (!to) return unexpected(to.error());
  JointRapid out;
  JointWay& way = out.way;
  way.start = start;
  way.end = end;
  way.from = from;
  way.to = std::move(*to);
  way.tool_offset = tool_offset;
  way.kinematics = &kinematics;
  way.length = make_line(start, end).length;
  const machine::JointVector change = way.to - from;
  if (!(way.length > 0) || change.isZero(0)) return out;
  const JointLimits limits = limits_of(machine);
  if (machine.rapid() == machine::RapidMode::joint) {
    out.profile = s_curve(way.length, limits_along(limits, change, way.length));
    return out;
  }
  way.laws.resize(static_cast<std::size_t>(change.size()));
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    if (change[j] == 0) continue;
    SpeedProfile& law = way.laws[static_cast<std::size_t>(j)];
    law = s_curve(std::abs(change[j]), {limits.v[j], limits.a[j], limits.j[j]});
    way.seconds = std::max(way.seconds, law.duration());
  }
  const double speed = way.length / way.seconds;
  out.profile.knots = {{0, 0, speed, 0, 0}, {way.seconds, way.length, speed, 0, 0}};
  return out;
}

bool has_straight_rapids(const machine::Machine& machine, const machine::Kinematics& kinematics) {
  return machine.rapid() == machine::RapidMode::coordinated ||
         (machine.rapid() == machine::RapidMode::joint && kinematics.type() == "identity");
}

// The tip, by forward kinematics; its derivatives by differences.
PathPoint evaluate_joint_way(const JointWay& way, double s) {
  const auto tip = [&way](double at) {
    if (at <= 0) return way.start;
    if (at >= way.length) return way.end;
    const auto found = way.kinematics->forward(joint_point(way, at).q, way.tool_offset);
    return found ? *found : way.start + (at / way.length) * (way.end - way.start);
  };
  const double h = 1e-4 * way.length;
  const double low = std::max(s - h, 0.0), high = std::min(s + h, way.length);
  PathPoint out;
  out.p = tip(s);
  out.d = (1 / (high - low)) * (tip(high) - tip(low));
  return out;
}

}  // namespace aircut::plan
