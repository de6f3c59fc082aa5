// The geometry of contours: orientation, crossings, offset.
//
// Offset: each piece is moved by the distance, convex corners get an arc, then every piece is cut
// where it meets another one, and only the parts are kept that are nowhere nearer to the contour
// than the distance. What remains, in the order of the contour, is the offset curve; corners that
// the distance swallows disappear by themselves.
#include "interp/contour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::interp {
namespace {

constexpr double tiny = 1e-9;       // mm
constexpr double keep_band = 1e-6;  // mm, by which a part may be nearer than the distance
constexpr double two_pi = 2 * std::numbers::pi;

double radius_of(const ContourPiece& p) {
  return std::hypot(p.start.u - p.centre.u, p.start.v - p.centre.v);
}

double angle_at(const ContourPiece& p, PlanePoint q) {
  return std::atan2(q.v - p.centre.v, q.u - p.centre.u);
}

// The way from the start of an arc to the angle, in its own sense, 0 … 2π.
double turned(const ContourPiece& p, double angle) {
  double way = p.turn * (angle - angle_at(p, p.start));
  way = std::fmod(way, two_pi);
  if (way < 0) way += two_pi;
  return way;
}

double sweep_of(const ContourPiece& p) {
  const double way = turned(p, angle_at(p, p.end));
  return way < 1e-12 ? two_pi : way;
}

double distance(PlanePoint a, PlanePoint b) { return std::hypot(a.u - b.u, a.v - b.v); }

bool on_arc(const ContourPiece& p, double angle) {
  const double way = turned(p, angle);
  const double slack = tiny / std::max(radius_of(p), tiny);
  return way <= sweep_of(p) + slack || way >= two_pi - slack;
}

PlanePoint on_circle(const ContourPiece& p, double angle) {
  const double r = radius_of(p);
  return {p.centre.u + r * std::cos(angle), p.centre.v + r * std::sin(angle)};
}

// An arc cut at the given directions from its centre.
Contour split_at(const Contour& contour, double first_angle) {
  Contour parts;
  for (const ContourPiece& piece : contour) {
    if (piece.turn == 0) {
      parts.push_back(piece);
      continue;
    }
    const double sweep = sweep_of(piece);
    const double slack = 1e-7 / std::max(radius_of(piece), 1e-7);
    std::vector<double> ways;
    for (const double angle : {first_angle, first_angle + std::numbers::pi})
      if (const double way = turned(piece, angle); way > slack && way < sweep - slack)
        ways.push_back(way);
    std::sort(ways.begin(), ways.end());
    ContourPiece part = piece;
    for (const double way : ways) {
      part.end = on_circle(piece, angle_at(piece, piece.start) + piece.turn * way);
      parts.push_back(part);
      part.start = part.end;
    }
    part.end = piece.end;
    parts.push_back(part);
  }
  return parts;
}

// Direction of travel at a point of the piece.
PlanePoint direction(const ContourPiece& p, PlanePoint at) {
  if (p.turn == 0) {
    const double length = std::max(distance(p.start, p.end), tiny);
    return {(p.end.u - p.start.u) / length, (p.end.v - p.start.v) / length};
  }
  const double r = std::max(radius_of(p), tiny);
  return {-p.turn * (at.v - p.centre.v) / r, p.turn * (at.u - p.centre.u) / r};
}

// The stock is on the right-hand side of the way.
PlanePoint beside(const ContourPiece& p, PlanePoint at, double distance) {
  const PlanePoint d = direction(p, at);
  return {at.u + d.v * distance, at.v - d.u * distance};
}

std::optional<ContourPiece> moved_beside(const ContourPiece& p, double distance) {
  ContourPiece result = p;
  // To the right of a counter-clockwise arc is its outside.
  if (p.turn != 0 && radius_of(p) + p.turn * distance < tiny) return std::nullopt;
  result.start = beside(p, p.start, distance);
  result.end = beside(p, p.end, distance);
  return result;
}

double distance_to(const ContourPiece& p, PlanePoint q) {
  const double ends = std::min(distance(p.start, q), distance(p.end, q));
  if (p.turn != 0) {
    if (!on_arc(p, angle_at(p, q))) return ends;
    return std::min(ends, std::fabs(distance(p.centre, q) - radius_of(p)));
  }
  const double du = p.end.u - p.start.u, dv = p.end.v - p.start.v;
  const double length2 = du * du + dv * dv;
  if (length2 < tiny * tiny) return ends;
  const double s = ((q.u - p.start.u) * du + (q.v - p.start.v) * dv) / length2;
  if (s < 0 || s > 1) return ends;
  return std::fabs((q.u - p.start.u) * dv - (q.v - p.start.v) * du) / std::sqrt(length2);
}

// Whether a point of the carrier (line or circle) lies on the piece.
bool contains(const ContourPiece& p, PlanePoint q) {
  if (p.turn != 0) return on_arc(p, angle_at(p, q));
  const double du = p.end.u - p.start.u, dv = p.end.v - p.start.v;
  const double length = std::hypot(du, dv);
  const double along = ((q.u - p.start.u) * du + (q.v - p.start.v) * dv) / std::max(length, tiny);
  return along >= -tiny && along <= length + tiny;
}

// `slack`: by how much r² may be missed, for each mm of r, and the foot still counts.
void line_circle(const ContourPiece& line, PlanePoint centre, double r, double slack,
                 std::vector<PlanePoint>& out) {
  const PlanePoint d = direction(line, line.start);
  const double along = (centre.u - line.start.u) * d.u + (centre.v - line.start.v) * d.v;
  const PlanePoint foot{line.start.u + along * d.u, line.start.v + along * d.v};
  const double h2 = r * r - std::pow(distance(foot, centre), 2);
  if (h2 < -slack * std::max(r, 1.0)) return;
  const double half = std::sqrt(std::max(0.0, h2));
  out.push_back({foot.u - half * d.u, foot.v - half * d.v});
  out.push_back({foot.u + half * d.u, foot.v + half * d.v});
}

// Where the lines and circles that carry the pieces meet.
std::vector<PlanePoint> carriers_meet(const ContourPiece& a, const ContourPiece& b, double slack) {
  std::vector<PlanePoint> points;
  if (a.turn == 0 && b.turn == 0) {
    const PlanePoint da = direction(a, a.start), db = direction(b, b.start);
    const double cross = da.u * db.v - da.v * db.u;
    if (std::fabs(cross) > 1e-12) {
      const double s = ((b.start.u - a.start.u) * db.v - (b.start.v - a.start.v) * db.u) / cross;
      points.push_back({a.start.u + s * da.u, a.start.v + s * da.v});
    }
  } else if (a.turn == 0 || b.turn == 0) {
    const ContourPiece& line = a.turn == 0 ? a : b;
    const ContourPiece& arc = a.turn == 0 ? b : a;
    line_circle(line, arc.centre, radius_of(arc), slack, points);
  } else {
    const double ra = radius_of(a), rb = radius_of(b), d = distance(a.centre, b.centre);
    if (d > tiny) {
      const double along = (d * d + ra * ra - rb * rb) / (2 * d);
      const double h2 = ra * ra - along * along;
      if (h2 > -slack * std::max(ra, 1.0)) {
        const double half = std::sqrt(std::max(0.0, h2));
        const double cu = (b.centre.u - a.centre.u) / d, cv = (b.centre.v - a.centre.v) / d;
        const PlanePoint foot{a.centre.u + along * cu, a.centre.v + along * cv};
        points.push_back({foot.u - half * cv, foot.v + half * cu});
        points.push_back({foot.u + half * cv, foot.v - half * cu});
      }
    }
  }
  return points;
}

std::vector<PlanePoint> meetings(const ContourPiece& a, const ContourPiece& b) {
  std::vector<PlanePoint> points = carriers_meet(a, b, 1e-7);
  std::erase_if(points, [&](PlanePoint q) { return !contains(a, q) || !contains(b, q); });
  return points;
}

// How far along the piece a point of it lies, for sorting.
double way_along(const ContourPiece& p, PlanePoint q) {
  if (p.turn == 0) return distance(p.start, q);
  const double way = turned(p, angle_at(p, q));
  return way > sweep_of(p) + 1e-6 ? 0 : way * radius_of(p);
}

PlanePoint middle_of(const ContourPiece& p) {
  if (p.turn == 0) return {(p.start.u + p.end.u) / 2, (p.start.v + p.end.v) / 2};
  return on_circle(p, angle_at(p, p.start) + p.turn * sweep_of(p) / 2);
}

double length_of(const ContourPiece& p) {
  return p.turn == 0 ? distance(p.start, p.end) : sweep_of(p) * radius_of(p);
}

// Lets two moved pieces with a gap or overlap between them that is narrow along u end and begin
// where their carriers meet. False when these meet nowhere near.
bool join(ContourPiece& a, ContourPiece& b, double narrow) {
  const double gap = distance(a.end, b.start);
  if (gap < tiny || std::fabs(a.end.u - b.start.u) >= narrow) return false;
  const PlanePoint middle{(a.end.u + b.start.u) / 2, (a.end.v + b.start.v) / 2};
  PlanePoint best = middle;
  // Pieces that are almost tangent meet far from their ends.
  const double reach = gap + std::min({length_of(a) / 2, length_of(b) / 2, 10 * narrow});
  double nearest = reach;
  for (const PlanePoint q : carriers_meet(a, b, 2 * narrow)) {
    if (distance(q, middle) >= nearest) continue;
    nearest = distance(q, middle);
    best = q;
  }
  if (nearest >= reach) return false;
  a.end = b.start = best;
  return true;
}

// The arc round the convex corner between two moved pieces, nothing at a concave one.
std::optional<ContourPiece> round_corner(const ContourPiece& piece, const ContourPiece& next,
                                         double d) {
  const PlanePoint in = direction(piece, piece.end), out = direction(next, next.start);
  // Seen from the side of the offset, the way turns away from it at a convex corner.
  if ((in.u * out.v - in.v * out.u) * d <= 1e-9 * std::fabs(d)) return std::nullopt;
  ContourPiece round;
  round.start = beside(piece, piece.end, d);
  round.end = beside(next, next.start, d);
  round.centre = piece.end;
  round.turn = d > 0 ? 1 : -1;
  round.feed = piece.feed;
  if (distance(round.start, round.end) <= tiny) return std::nullopt;
  return round;
}

// The pieces beside the contour with arcs round its corners, not yet cut.
Contour raw_offset(const Contour& contour, double d, double narrow) {
  Contour raw;
  bool whole = false;  // the piece before this one is there
  for (std::size_t i = 0; i < contour.size(); ++i) {
    std::optional<ContourPiece> moved = moved_beside(contour[i], d);
    const bool joined = whole && moved && join(raw.back(), *moved, narrow);
    if (i > 0 && !joined)
      if (const auto round = round_corner(contour[i - 1], contour[i], d)) raw.push_back(*round);
    whole = moved.has_value();
    if (moved) raw.push_back(*moved);
  }
  return raw;
}

}  // namespace

PlanePoint mirrored(PlanePoint point, Mirror mirror) {
  return {mirror.u ? -point.u : point.u, mirror.v ? -point.v : point.v};
}

ContourPiece mirrored(ContourPiece piece, Mirror mirror) {
  piece.start = mirrored(piece.start, mirror);
  piece.end = mirrored(piece.end, mirror);
  piece.centre = mirrored(piece.centre, mirror);
  if (mirror.u != mirror.v) piece.turn = -piece.turn;
  return piece;
}

Mirror working_orientation(const Contour& contour) {
  if (contour.empty()) return {};
  return {contour.back().end.u > contour.front().start.u,
          contour.back().end.v < contour.front().start.v};
}

Contour split_at_v_extremes(const Contour& contour) {
  return split_at(contour, std::numbers::pi / 2);
}
Contour split_at_u_extremes(const Contour& contour) { return split_at(contour, 0); }

std::optional<std::size_t> first_going_back(const Contour& contour, bool v_too) {
  constexpr double band = 1e-6;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    for (const ContourPiece& part : split_at_u_extremes({contour[i]}))
      if (part.end.u > part.start.u + band) return i;
    if (!v_too) continue;
    for (const ContourPiece& part : split_at_v_extremes({contour[i]}))
      if (part.end.v < part.start.v - band) return i;
  }
  return std::nullopt;
}

std::vector<double> crossings(const ContourPiece& p, double v) {
  const double low = std::min(p.start.v, p.end.v), high = std::max(p.start.v, p.end.v);
  if (p.turn == 0) {
    if (v < low - tiny || v > high + tiny) return {};
    if (high - low < tiny) return {p.start.u, p.end.u};
    const double s = std::clamp((v - p.start.v) / (p.end.v - p.start.v), 0.0, 1.0);
    return {p.start.u + s * (p.end.u - p.start.u)};
  }
  const double r = radius_of(p), dv = v - p.centre.v;
  if (std::fabs(dv) > r + tiny) return {};
  const double half = std::sqrt(std::max(0.0, r * r - dv * dv));
  std::vector<double> found;
  for (const double side : {-half, half})
    if (on_arc(p, std::atan2(dv, side))) found.push_back(p.centre.u + side);
  return found;
}

std::optional<double> next_crossing(const Contour& contour, std::size_t first, double u, double v) {
  std::optional<double> nearest;
  for (std::size_t i = first; i < contour.size(); ++i)
    for (const double at : crossings(contour[i], v))
      if (at < u - 1e-7 && (!nearest || at > *nearest)) nearest = at;
  return nearest;
}

Contour shifted(Contour contour, double du, double dv) {
  for (ContourPiece& piece : contour)
    for (PlanePoint* point : {&piece.start, &piece.end, &piece.centre}) {
      point->u += du;
      point->v += dv;
    }
  return contour;
}

Contour offset(const Contour& contour, double d, double narrow) {
  if (d == 0) return contour;
  const Contour raw = raw_offset(contour, d, narrow);
  Contour kept;
  std::size_t last_of = raw.size();  // the raw piece that the last kept part is of
  for (std::size_t i = 0; i < raw.size(); ++i) {
    std::vector<PlanePoint> cuts;
    for (std::size_t j = 0; j < raw.size(); ++j) {
      if (i == j) continue;
      for (const PlanePoint q : meetings(raw[i], raw[j])) cuts.push_back(q);
    }
    std::sort(cuts.begin(), cuts.end(), [&](PlanePoint a, PlanePoint b) {
      return way_along(raw[i], a) < way_along(raw[i], b);
    });
    cuts.push_back(raw[i].end);
    ContourPiece part = raw[i];
    for (const PlanePoint q : cuts) {
      part.end = q;
      if (distance(part.start, q) > 1e-7 && length_of(part) < length_of(raw[i]) + 1e-6) {
        const PlanePoint middle = middle_of(part);
        double nearest = std::fabs(d);
        for (const ContourPiece& original : contour)
          nearest = std::min(nearest, distance_to(original, middle));
        const bool keep = nearest > std::fabs(d) - keep_band;
        const bool goes_on = last_of == i && distance(kept.back().end, part.start) < tiny;
        if (keep && goes_on) kept.back().end = part.end;
        if (keep && !goes_on) kept.push_back(part);
        if (keep) last_of = i;
      }
      part.start = q;
    }
  }
  // Ends that meet but for rounding are one point.
  for (std::size_t i = 1; i < kept.size(); ++i)
    if (distance(kept[i - 1].end, kept[i].start) < 1e-5) kept[i].start = kept[i - 1].end;
  return kept;
}

}  // namespace aircut::interp
