#include "peer/stand_in.h"

#include <cmath>

#include "base/overloaded.h"

namespace aircut::test {
namespace {

constexpr double stops_before = 0.254;  // mm
constexpr Axis linear_axes[] = {Axis::x, Axis::y, Axis::z};

AxisValues turned(AxisValues v, double angle) {
  const double x = v[Axis::x], y = v[Axis::y];
  v[Axis::x] = x * std::cos(angle) - y * std::sin(angle);
  v[Axis::y] = x * std::sin(angle) + y * std::cos(angle);
  return v;
}

}  // namespace

AxisValues StandInProbe::program_of(const AxisValues& tip) const {
  return turned(tip - work_, -rotation_) - g92_;
}

AxisValues StandInProbe::tip_of(const AxisValues& program) const {
  return turned(program + g92_, rotation_) + work_;
}

interp::ProbeHit StandInProbe::probe(const AxisValues& target) {
  double length = 0;
  for (const Axis axis : linear_axes) length = std::hypot(length, target[axis] - believed_[axis]);
  AxisValues end = target;
  if (length > 0)
    for (const Axis axis : linear_axes)
      end[axis] -= (target[axis] - believed_[axis]) * stops_before / length;
  believed_ = end;
  tip_ = tip_of(end);
  return {.tip = tip_, .tripped = false};
}

std::optional<interp::ProbeHit> StandInProbe::follow(const canon::Command& command) {
  if (const auto* move = std::get_if<canon::Probe>(&command.action))
    return probe(program_of(move->end));
  if (canon::is_motion(command.action)) {
    tip_ = canon::end_of(command.action, tip_);
    believed_ = program_of(tip_);
    return std::nullopt;
  }
  std::visit(
      overloaded{[&](const canon::WorkOffset& c) {
                   believed_ = believed_ + work_ - c.offset;
                   work_ = c.offset;
                 },
                 [&](const canon::G92Offset& c) {
                   believed_ = believed_ + g92_ - c.offset;
                   g92_ = c.offset;
                 },
                 [&](const canon::WorkRotation& c) { rotation_ = c.angle; }, [](const auto&) {}},
      command.action);
  return std::nullopt;
}

}  // namespace aircut::test
