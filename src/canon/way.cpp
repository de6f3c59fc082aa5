#include "canon/way.h"

#include <cmath>
#include <numbers>

namespace aircut::canon {
namespace {

Vec3 xyz(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

}  // namespace

Way straight_way(const AxisValues& from, const AxisValues& to) {
  const AxisValues way = to - from;
  const auto norm = [&](Axis a, Axis b, Axis c) { return std::hypot(way[a], way[b], way[c]); };
  constexpr double rest = 1e-12;
  if (const double length = norm(Axis::x, Axis::y, Axis::z); length > rest) return {length, false};
  if (const double length = norm(Axis::u, Axis::v, Axis::w); length > rest) return {length, false};
  return {norm(Axis::a, Axis::b, Axis::c), true};
}

// The radius is that of the start. Ends that are closer than `nothing` are one point, which means a
// full turn.
Way arc_way(const AxisValues& from, const ArcFeed& arc) {
  if (arc.turns == 0) return straight_way(from, arc.end);
  constexpr double full = 2 * std::numbers::pi, nothing = 1e-12;
  const Vec3 n = arc.normal.normalized(), start = xyz(from) - arc.centre,
             end = xyz(arc.end) - arc.centre;
  const Vec3 p = start - start.dot(n) * n, q = end - end.dot(n) * n;
  double sweep = std::atan2(p.cross(q).dot(n), p.dot(q));
  if (arc.turns < 0) sweep = -sweep;
  if (sweep <= nothing) sweep += full;
  sweep += full * (std::abs(arc.turns) - 1);
  return {std::hypot(p.norm() * sweep, (end - start).dot(n)), false};
}

}  // namespace aircut::canon
