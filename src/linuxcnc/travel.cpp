// Soft limits of the program axes. A straight move stays between its ends, so those are looked at;
// an arc
//
//   p(θ) = centre + r(θ) (u cos θ + v sin θ) + along the normal
//
// is farthest along axis i where tan θ = vᵢ / uᵢ, so those angles on its way are looked at too. The
// radius changes by less than the arc tolerance on the way, which moves these angles by nothing
// that counts.
#include <cmath>
#include <numbers>

#include "linuxcnc/linuxcnc.h"

namespace aircut::linuxcnc {
namespace {

constexpr double radian_per_degree = std::numbers::pi / 180;
constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-6;  // mm or rad, of positions that went through several frames

std::string with_unit(Axis axis, double value) {
  const bool rotary = is_rotary(axis);
  const double shown = std::round(value / (rotary ? radian_per_degree : 1) * 1e6) / 1e6;
  return shortest(shown) + (rotary ? " degrees" : " mm");
}

Vec3 xyz(const AxisValues& values) { return {values[Axis::x], values[Axis::y], values[Axis::z]}; }

}  // namespace

void TravelCheck::see(const canon::Command& command, Diagnostics& out) {
  if (const auto* offset = std::get_if<canon::ToolLengthOffset>(&command.action)) {
    // The axes stay where they are.
    tip_ += length_offset_ - offset->offset;
    length_offset_ = offset->offset;
    return;
  }
  // In other kinematics the tip is elsewhere, and its axes need not be these.
  if (std::holds_alternative<canon::SwitchKinematics>(command.action)) tip_known_ = false;
  if (!canon::is_motion(command.action)) return;
  if (const auto* arc = std::get_if<canon::ArcFeed>(&command.action); arc && tip_known_)
    bulges(*arc, command, out);
  tip_known_ = true;
  const AxisValues end = canon::end_of(command.action, tip_);
  if (const auto* tap = std::get_if<canon::SyncFeed>(&command.action); tap && tap->rigid_tap)
    point(tap->end, command, out);
  point(end, command, out);
  tip_ = end;
}

void TravelCheck::bulges(const canon::ArcFeed& arc, const canon::Command& command,
                         Diagnostics& out) {
  const Vec3 n = arc.turns >= 0 ? arc.normal : Vec3(-arc.normal);
  const auto in_plane = [&](const AxisValues& p) {
    const Vec3 d = xyz(p) - arc.centre;
    return Vec3(d - d.dot(n) * n);
  };
  const Vec3 from = in_plane(tip_), to = in_plane(arc.end);
  const double r0 = from.norm(), r1 = to.norm();
  if (r0 == 0) return;
  const Vec3 u = from / r0, v = n.cross(u);
  double sweep = std::atan2(to.dot(v), to.dot(u));
  constexpr double same_point = 1e-12;
  if (sweep <= same_point) sweep += 2 * pi;
  sweep += 2 * pi * (std::abs(arc.turns) - 1);
  for (int i = 0; i < 3; ++i) {
    double angle = std::atan2(v[i], u[i]);
    if (angle < 0) angle += pi;
    for (int k = 0; k < 4 && angle < sweep; ++k, angle += pi) {
      const double part = angle / sweep;
      AxisValues p = tip_;
      for (const Axis axis : all_axes) p[axis] += part * (arc.end[axis] - tip_[axis]);
      const Vec3 along = (xyz(p) - arc.centre).dot(n) * n;
      const Vec3 q = arc.centre + along +
                     (r0 + part * (r1 - r0)) * (u * std::cos(angle) + v * std::sin(angle));
      p[Axis::x] = q.x(), p[Axis::y] = q.y(), p[Axis::z] = q.z();
      point(p, command, out);
    }
  }
}

void TravelCheck::point(const AxisValues& tip, const canon::Command& command, Diagnostics& out) {
  for (const auto& [axis, travel] : travel_) {
    const double position = tip[axis] + length_offset_[axis];
    const bool above = travel.max && position > *travel.max + rounding;
    const bool below = travel.min && position < *travel.min - rounding;
    if (!above && !below) continue;
    if (!told_.emplace(command.span.text, command.span.begin, axis, above).second) continue;
    const double limit = above ? *travel.max : *travel.min;
    Diagnostic d = make_error("overtravel", command.span,
                              std::string(1, letter(axis)) + " goes to machine position " +
                                  with_unit(axis, position) + ", " +
                                  with_unit(axis, std::fabs(position - limit)) +
                                  " beyond its limit of " + with_unit(axis, limit));
    const SourceSpan& said = above ? travel.max_span : travel.min_span;
    d.notes.push_back({"limit", said.place()});
    out.add(std::move(d));
  }
}

}  // namespace aircut::linuxcnc
