// The piece [ta, tb] of a segment. Its time law is the part of the knots between both times, with s
// counted from the piece's start; its path is the part of the path that is passed meanwhile:
//
//   line    the points at both ends                    blend   the same curve, begun later
//   arc     turned to where the piece begins; radius, angle and rise go on evenly with s
//   joints  straight between the joints at both ends
#include "plan/part.h"

#include <algorithm>
#include <cmath>

namespace aircut::plan {

namespace {

SpeedProfile part_of(const SpeedProfile& profile, double from, double to) {
  SpeedProfile out;
  const auto state = [&](double t) { return profile.at(t); };
  const double s0 = state(from).s;
  ProfileKnot first{0, 0, state(from).v, state(from).a, 0};
  for (const ProfileKnot& knot : profile.knots)
    if (knot.t <= from) first.j = knot.j;
  out.knots.push_back(first);
  for (const ProfileKnot& knot : profile.knots)
    if (knot.t > from && knot.t < to)
      out.knots.push_back({knot.t - from, knot.s - s0, knot.v, knot.a, knot.j});
  out.knots.push_back({to - from, state(to).s - s0, state(to).v, state(to).a, 0});
  return out;
}

std::optional<Path> part_of(const Path& path, double s0, double s1) {
  const double way = s1 - s0;
  if (!(way > 0)) return Hold{evaluate(path, s0).p};
  return std::visit(
      overloaded{
          [](const Hold& hold) { return std::optional<Path>(hold); },
          [&](const Line&) {
            return std::optional<Path>(Line{evaluate(path, s0).p, evaluate(path, s1).p, way});
          },
          [&](const Arc& arc) {
            Arc out = arc;
            const double phi = arc.angle * s0 / arc.length;
            const auto radius = [&](double s) {
              return arc.start_radius + (arc.end_radius - arc.start_radius) * s / arc.length;
            };
            out.start = evaluate(path, s0).p;
            out.end = evaluate(path, s1).p;
            out.radial = std::cos(phi) * arc.radial + std::sin(phi) * arc.normal.cross(arc.radial);
            out.start_radius = radius(s0);
            out.end_radius = radius(s1);
            out.angle = arc.angle * way / arc.length;
            out.rise = arc.rise * way / arc.length;
            out.length = way;
            return std::optional<Path>(out);
          },
          [&](const Blend& blend) {
            Blend out = blend;
            out.begin += s0;
            out.length = way;
            return std::optional<Path>(out);
          },
          [&](const JointWay& joints) -> std::optional<Path> {
            if (!joints.laws.empty()) return std::nullopt;
            JointWay out = joints;
            out.start = evaluate(path, s0).p;
            out.end = evaluate(path, s1).p;
            out.from = joint_point(joints, s0).q;
            out.to = joint_point(joints, s1).q;
            out.length = way;
            return std::optional<Path>(out);
          },
      },
      path);
}

}  // namespace

std::optional<Segment> part_of(const Segment& segment, double ta, double tb) {
  if (ta <= segment.t_start && tb >= segment.t_end()) return segment;
  const double from = std::max(ta - segment.t_start, 0.0);
  const double to = std::min(tb - segment.t_start, segment.duration());
  const double s0 = segment.profile.at(from).s, s1 = segment.profile.at(to).s;
  auto path = part_of(segment.path, s0, s1);
  if (!path) return std::nullopt;
  Segment out = segment;
  out.path = std::move(*path);
  out.profile = part_of(segment.profile, from, to);
  out.t_start = segment.t_start + from;
  if (const double whole = length(segment.path); whole > 0) {
    out.u0 = segment.u0 + (segment.u1 - segment.u0) * s0 / whole;
    out.u1 = segment.u0 + (segment.u1 - segment.u0) * s1 / whole;
  }
  if (segment.spindle_from) {
    out.spindle_from = spindle_rpm(segment, from);
    out.spindle_rpm = spindle_rpm(segment, to);
  }
  if (out.trip) *out.trip -= s0;
  if (tb < segment.t_end()) out.failure.reset();
  return out;
}

}  // namespace aircut::plan
