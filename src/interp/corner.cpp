// A fillet's centre lies at its radius from both pieces, on the inside of the corner: it is where
// the carriers (lines, circles) moved by the radius to that side meet, nearest to the corner. Its
// ends are the feet of the centre on the two carriers.
#include "interp/corner.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace aircut::interp {
namespace {

constexpr double tiny = 1e-9;

double distance(PlanePoint a, PlanePoint b) { return std::hypot(a.u - b.u, a.v - b.v); }

PlanePoint direction(const ContourPiece& p, PlanePoint at) {
  if (p.turn == 0) {
    const double length = std::max(distance(p.start, p.end), tiny);
    return {(p.end.u - p.start.u) / length, (p.end.v - p.start.v) / length};
  }
  const double r = std::max(distance(p.start, p.centre), tiny);
  return {-p.turn * (at.v - p.centre.v) / r, p.turn * (at.u - p.centre.u) / r};
}

// A carrier moved by `d` to the left of its way; a circle as centre and radius.
struct Carrier {
  bool is_circle = false;
  PlanePoint point;  // of the line, or the centre
  PlanePoint along;
  double radius = 0;
};

Carrier moved(const ContourPiece& p, double d) {
  if (p.turn != 0) return {true, p.centre, {}, distance(p.start, p.centre) - p.turn * d};
  const PlanePoint t = direction(p, p.start);
  return {false, {p.start.u - d * t.v, p.start.v + d * t.u}, t, 0};
}

std::vector<PlanePoint> meet(const Carrier& a, const Carrier& b) {
  if (!a.is_circle && !b.is_circle) {
    const double cross = a.along.u * b.along.v - a.along.v * b.along.u;
    if (std::fabs(cross) < 1e-12) return {};
    const double s =
        ((b.point.u - a.point.u) * b.along.v - (b.point.v - a.point.v) * b.along.u) / cross;
    return {{a.point.u + s * a.along.u, a.point.v + s * a.along.v}};
  }
  if (!a.is_circle) return meet(b, a);
  if (a.radius < tiny) return {};
  if (!b.is_circle) {
    const double s = (a.point.u - b.point.u) * b.along.u + (a.point.v - b.point.v) * b.along.v;
    const PlanePoint foot{b.point.u + s * b.along.u, b.point.v + s * b.along.v};
    const double h2 = a.radius * a.radius - std::pow(distance(foot, a.point), 2);
    if (h2 < -1e-9) return {};
    const double h = std::sqrt(std::max(0.0, h2));
    return {{foot.u + h * b.along.u, foot.v + h * b.along.v},
            {foot.u - h * b.along.u, foot.v - h * b.along.v}};
  }
  const double d = distance(a.point, b.point);
  if (d < tiny || b.radius < tiny) return {};
  const double s = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
  const double h2 = a.radius * a.radius - s * s;
  if (h2 < -1e-9) return {};
  const double h = std::sqrt(std::max(0.0, h2));
  const double cu = (b.point.u - a.point.u) / d, cv = (b.point.v - a.point.v) / d;
  const PlanePoint foot{a.point.u + s * cu, a.point.v + s * cv};
  return {{foot.u - h * cv, foot.v + h * cu}, {foot.u + h * cv, foot.v - h * cu}};
}

// The point of the piece's carrier nearest to `q`.
PlanePoint foot_on(const ContourPiece& p, PlanePoint q) {
  if (p.turn != 0) {
    const double r = distance(p.start, p.centre), d = std::max(distance(q, p.centre), tiny);
    return {p.centre.u + (q.u - p.centre.u) * r / d, p.centre.v + (q.v - p.centre.v) * r / d};
  }
  const PlanePoint t = direction(p, p.start);
  const double s = (q.u - p.start.u) * t.u + (q.v - p.start.v) * t.v;
  return {p.start.u + s * t.u, p.start.v + s * t.v};
}

bool lies_on(const ContourPiece& p, PlanePoint q) {
  constexpr double slack = 1e-6;
  if (p.turn == 0) {
    const PlanePoint t = direction(p, p.start);
    const double s = (q.u - p.start.u) * t.u + (q.v - p.start.v) * t.v;
    return s > -slack && s < distance(p.start, p.end) + slack;
  }
  constexpr double two_pi = 2 * std::numbers::pi;
  const auto way = [&](PlanePoint to) {
    const double angle = std::atan2(to.v - p.centre.v, to.u - p.centre.u) -
                         std::atan2(p.start.v - p.centre.v, p.start.u - p.centre.u);
    const double turned = std::fmod(p.turn * angle, two_pi);
    return turned < -1e-9 ? turned + two_pi : std::max(turned, 0.0);
  };
  const double sweep = way(p.end);
  return way(q) <= (sweep < 1e-12 ? two_pi : sweep) + slack / distance(p.start, p.centre);
}

// The point of a piece at the straight distance `d` from its end at the corner.
std::optional<PlanePoint> away_from(const ContourPiece& p, PlanePoint corner, double d) {
  if (p.turn == 0) {
    const double sign = distance(corner, p.start) < tiny ? 1 : -1;
    const PlanePoint t = direction(p, p.start);
    return PlanePoint{corner.u + sign * d * t.u, corner.v + sign * d * t.v};
  }
  const Carrier circle = moved(p, 0);
  for (const PlanePoint q : meet(circle, {true, corner, {}, d}))
    if (lies_on(p, q)) return q;
  return std::nullopt;
}

}  // namespace

std::optional<ContourPiece> cut_corner(const ContourPiece& before, const ContourPiece& after,
                                       CornerWord word) {
  const PlanePoint corner = before.end;
  ContourPiece cut;
  cut.feed = before.feed;
  if (word.kind == CornerWord::Kind::chamfer) {
    const auto from = away_from(before, corner, word.size),
               to = away_from(after, corner, word.size);
    if (!from || !to || !lies_on(before, *from) || !lies_on(after, *to)) return std::nullopt;
    cut.start = *from;
    cut.end = *to;
    return cut;
  }
  const PlanePoint in = direction(before, corner), out = direction(after, corner);
  const double turn = in.u * out.v - in.v * out.u;
  if (std::fabs(turn) < 1e-9) return std::nullopt;
  const double side = turn > 0 ? word.size : -word.size;  // the inside is left in a left turn
  std::optional<PlanePoint> centre;
  for (const PlanePoint q : meet(moved(before, side), moved(after, side)))
    if (lies_on(before, foot_on(before, q)) && lies_on(after, foot_on(after, q)) &&
        (!centre || distance(q, corner) < distance(*centre, corner)))
      centre = q;
  if (!centre) return std::nullopt;
  cut.start = foot_on(before, *centre);
  cut.end = foot_on(after, *centre);
  cut.centre = *centre;
  if (word.kind == CornerWord::Kind::round) cut.turn = turn > 0 ? 1 : -1;
  return cut;
}

}  // namespace aircut::interp
