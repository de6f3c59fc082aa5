// Making path pieces out of commands. Length rule (RS274): F counts along XYZ if any of them moves,
// else along UVW, else along ABC; the other axes just arrive together.
#include "plan/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::plan {
namespace {

constexpr double pi = std::numbers::pi;

Vec3 xyz_of(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// Length of a spiral helix whose radius and height go linearly with the angle:
// ∫ sqrt(ρ² φ'² + ρ'² + z'²) over f in [0, 1], with ρ = r0 + f dr. Closed form by the substitution
// x = ρ |angle|, c² = dr² + rise²: ∫ sqrt(x² + c²) dx = (x sqrt(x² + c²) + c² asinh(x / c)) / 2.
double spiral_length(double r0, double r1, double angle, double rise) {
  const double dr = r1 - r0;
  const double w = std::abs(angle);
  if (std::abs(dr) < 1e-6 * std::max(r0, r1)) {
    // Nearly a circle: the closed form would divide by a small number. Simpson's rule on this
    // range is exact far beyond double precision needs (relative error below (dr/r)⁴).
    const auto speed = [&](double f) {
      const double r = r0 + f * dr;
      return std::sqrt(r * r * w * w + dr * dr + rise * rise);
    };
    return (speed(0) + 4 * speed(0.5) + speed(1)) / 6;
  }
  const double c = std::hypot(dr, rise);
  const auto primitive = [&](double r) {
    const double x = r * w;
    return (x * std::hypot(x, c) + c * c * std::asinh(x / c)) / 2;
  };
  return (primitive(r1) - primitive(r0)) / (w * dr);
}

}  // namespace

Metric metric_of(const AxisValues& way) {
  for (const Metric metric : {Metric::xyz, Metric::uvw})
    if (metric_length(metric, way) > zero_length) return metric;
  return metric_length(Metric::abc, way) > zero_length ? Metric::abc : Metric::none;
}

double metric_length(Metric metric, const AxisValues& way) {
  const auto norm = [&way](Axis a, Axis b, Axis c) {
    return std::sqrt(way[a] * way[a] + way[b] * way[b] + way[c] * way[c]);
  };
  switch (metric) {
    case Metric::none:
      return 0;
    case Metric::xyz:
      return norm(Axis::x, Axis::y, Axis::z);
    case Metric::uvw:
      return norm(Axis::u, Axis::v, Axis::w);
    case Metric::abc:
      return norm(Axis::a, Axis::b, Axis::c);
  }
  return 0;
}

Line make_line(const AxisValues& start, const AxisValues& end) {
  const AxisValues way = end - start;
  return {start, end, metric_length(metric_of(way), way)};
}

Expected<Arc> make_arc(const AxisValues& start, const canon::ArcFeed& command) {
  Arc arc;
  arc.start = start;
  arc.end = command.end;
  arc.centre = command.centre;
  const double size = command.normal.norm();
  if (!(size > 1e-9))
    return unexpected(make_error("arc_error", "the arc has no axis direction; it needs a plane"));
  arc.normal = command.normal / size;
  const Vec3 from = xyz_of(start) - arc.centre, to = xyz_of(command.end) - arc.centre;
  const Vec3 r0 = from - from.dot(arc.normal) * arc.normal;
  const Vec3 r1 = to - to.dot(arc.normal) * arc.normal;
  arc.start_radius = r0.norm();
  arc.end_radius = r1.norm();
  if (arc.start_radius < zero_length || arc.end_radius < zero_length)
    return unexpected(make_error(
        "arc_error", "the arc's start or end lies on its axis; a radius above zero is needed"));
  arc.radial = r0 / arc.start_radius;
  arc.rise = (to - from).dot(arc.normal);
  double angle = std::atan2(arc.normal.cross(arc.radial).dot(r1), arc.radial.dot(r1));
  // Equal ends mean a full turn. Ends that differ by less than rounding of the text (1e-9 rad of
  // the angle) count as equal, so that a hair's breadth never decides between nothing and a turn.
  constexpr double same = 1e-9;
  const double extra = 2 * pi * (std::abs(command.turns) - 1);
  if (command.turns > 0) {
    if (angle <= same) angle += 2 * pi;
    arc.angle = angle + extra;
  } else {
    if (angle >= -same) angle -= 2 * pi;
    arc.angle = angle - extra;
  }
  arc.length = spiral_length(arc.start_radius, arc.end_radius, arc.angle, arc.rise);
  return arc;
}

Expected<Path> path_of(const AxisValues& start, const canon::Action& action) {
  if (std::holds_alternative<canon::SplineFeed>(action))
    return unexpected(make_error("unsupported_code", "there is no model for a spline (G5.2)"));
  if (const auto* arc = std::get_if<canon::ArcFeed>(&action); arc && arc->turns != 0) {
    auto made = make_arc(start, *arc);
    if (!made) return unexpected(made.error());
    return Path(std::move(*made));
  }
  if (!canon::is_motion(action)) return Path(Hold{start});
  if (const auto* sync = std::get_if<canon::SyncFeed>(&action))
    return Path(make_line(start, sync->end));  // a rigid tap comes back the same way
  return Path(make_line(start, canon::end_of(action, start)));
}

Path sub_path(const Path& path, double s0, double s1) {
  return std::visit(
      overloaded{
          [](const Hold& hold) -> Path { return hold; },
          [&](const Line& line) -> Path {
            return Line{s0 <= 0 ? line.start : evaluate(line, s0).p, evaluate(line, s1).p, s1 - s0};
          },
          [&](const Arc& arc) -> Path {
            Arc out = arc;
            const double f0 = s0 / arc.length, f1 = s1 / arc.length;
            const double dr = arc.end_radius - arc.start_radius;
            const Vec3 e2 = arc.normal.cross(arc.radial);
            if (s0 > 0) {
              out.start = evaluate(arc, s0).p;
              out.radial = std::cos(arc.angle * f0) * arc.radial + std::sin(arc.angle * f0) * e2;
            }
            if (s1 < arc.length) out.end = evaluate(arc, s1).p;
            out.start_radius = arc.start_radius + f0 * dr;
            out.end_radius = arc.start_radius + f1 * dr;
            out.angle = arc.angle * (f1 - f0);
            out.rise = arc.rise * (f1 - f0);
            out.length = s1 - s0;
            return out;
          },
          [&](const Blend& blend) -> Path {
            Blend out = blend;
            out.begin = blend.begin + s0;
            out.length = s1 - s0;
            return out;
          },
          [](const JointWay& way) -> Path { return way; }},  // never cut
      path);
}

Metric metric_of(const Path& path) {
  return std::visit(
      overloaded{[](const Hold&) { return Metric::none; },
                 [](const Line& line) { return metric_of(line.end - line.start); },
                 [](const Arc&) { return Metric::xyz; },
                 [](const Blend& blend) {
                   AxisValues way;  // of the control polygon: can't cancel out
                   for (std::size_t i = 1; i < 6; ++i)
                     for (const Axis axis : all_axes)
                       way[axis] += std::abs(blend.control[i][axis] - blend.control[i - 1][axis]);
                   return metric_of(way);
                 },
                 [](const JointWay& way) { return metric_of(way.end - way.start); }},
      path);
}

double metric_speed(const Path& path, const PathPoint& point) {
  return metric_length(metric_of(path), point.d);
}

}  // namespace aircut::plan
