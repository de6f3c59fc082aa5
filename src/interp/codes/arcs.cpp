// G2 and G3: centre format (I J K, relative or absolute) and radius format, helices, extra turns.
//
// All is worked out in the plane's two program axes (a, b) with normal n = a × b, then turned into
// machine coordinates. Radius format: with h = half the chord and r the radius, the centre lies
// on the chord's bisector at d = sqrt(r² − h²) from its middle; for G3 with R > 0 to the left of
// the way from start to end, with R < 0 or G2 to the other side.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/held_move.h"

namespace aircut::interp {
namespace {

struct Point {
  double a = 0, b = 0;
};

struct PlaneWords {
  char centre_a, centre_b, forbidden;
};

// Offset words belong to X Y Z as I J K; the plane has two of them.
PlaneWords offset_words(canon::Plane plane) {
  switch (plane) {
    case canon::Plane::zx:
      return {'K', 'I', 'J'};
    case canon::Plane::yz:
      return {'J', 'K', 'I'};
    default:
      return {'I', 'J', 'K'};
  }
}

// std::hypot without its care for numbers near the ends of the range, where it is not needed.
double distance(double a, double b) {
  const double square = a * a + b * b;
  return square > 1e-200 && square < 1e200 ? std::sqrt(square) : std::hypot(a, b);
}

std::string mm(double value) { return fixed(value, 4) + " mm"; }

std::optional<Point> centre_from_radius(BlockRun& run, const CodeRule& rule, Point start,
                                        Point end) {
  const double r = run.length('R');
  const double chord_a = end.a - start.a, chord_b = end.b - start.b;
  const double chord = distance(chord_a, chord_b);
  const double scale = run.state.unit == canon::Unit::inch ? 25.4 * 0.00005 : 0.00127;
  if (chord < 1e-9) {
    run.error(
        "arc_error", 'R',
        "an arc with R must end at another point than it begins; use I J K for a full circle");
    return std::nullopt;
  }
  const double half = chord / 2;
  if (half - std::fabs(r) > scale) {
    run.error("arc_error", 'R',
              "the end is " + mm(chord) + " away, farther than twice the radius " +
                  mm(std::fabs(r)) + "; the radius must be at least " + mm(half));
    return std::nullopt;
  }
  const double height = std::sqrt(std::max(0.0, r * r - half * half));
  const bool left = (rule.code == 30) == (r > 0);
  const double sign = left ? 1 : -1;
  return Point{start.a + chord_a / 2 - sign * height * chord_b / chord,
               start.b + chord_b / 2 + sign * height * chord_a / chord};
}

std::optional<Point> centre_from_offsets(BlockRun& run, const CodeRule& rule, Point start) {
  const PlaneWords words = offset_words(run.state.plane);
  if (!run.state.absolute_centres)
    return Point{start.a + run.length(words.centre_a), start.b + run.length(words.centre_b)};
  if (!run.has(words.centre_a) || !run.has(words.centre_b)) {
    run.error("arc_error", rule,
              std::string("with G90.1 the centre needs both ") + words.centre_a + " and " +
                  words.centre_b);
    return std::nullopt;
  }
  return Point{run.length(words.centre_a), run.length(words.centre_b)};
}

// Start and end must lie on one circle, within the tolerance (interp.md 8).
bool radii_agree(BlockRun& run, const CodeRule& rule, Point start, Point end, Point centre) {
  const double r1 = distance(start.a - centre.a, start.b - centre.b);
  const double r2 = distance(end.a - centre.a, end.b - centre.b);
  const bool inch = run.state.unit == canon::Unit::inch;
  const double tolerance =
      inch ? run.session.options.arc_tolerance_inch * 25.4 : run.session.options.arc_tolerance;
  const double tiny = inch ? 25.4 * 0.00005 : 0.00127;
  if (r1 < tiny || r2 < tiny) {
    run.error("arc_error", rule,
              "the centre of the arc is its " + std::string(r1 < tiny ? "start" : "end") +
                  " point; the radius must be above 0");
    return false;
  }
  const double off = std::fabs(r1 - r2);
  const double relative = off / std::max(r1, r2);
  if (off <= 100 * tolerance && (off <= tolerance || relative <= 0.001 + 1e-12)) return true;
  run.error("arc_error", rule,
            "start and end of the arc have different distances from its centre: " + mm(r1) +
                " and " + mm(r2) + "; they may differ by " + mm(std::max(tolerance, 0.001 * r1)));
  return false;
}

bool words_fit(BlockRun& run, const CodeRule& rule) {
  const PlaneWords words = offset_words(run.state.plane);
  const bool offsets = run.has('I') || run.has('J') || run.has('K');
  if (run.state.plane >= canon::Plane::uv) {
    run.error("arc_error", rule, "arcs need the XY, ZX or YZ plane; give G17, G18 or G19 before");
    return false;
  }
  if (run.has(words.forbidden)) {
    run.error("arc_error", words.forbidden,
              std::string(1, words.forbidden) +
                  " can't be used in this plane; the centre is given by " + words.centre_a +
                  " and " + words.centre_b);
    return false;
  }
  if (run.has('R') && offsets) {
    run.error("arc_error", 'R', "R can't be given together with I J K; use one of both");
    return false;
  }
  if (!run.has('R') && !offsets) {
    run.error("arc_error", rule,
              name_of(rule) + " needs R or " + words.centre_a + " " + words.centre_b +
                  " to say where its centre is");
    return false;
  }
  return true;
}

// With unequal factors a circle would become an ellipse, which the controls do not drive: they make
// something else of it, each its own way.
bool keeps_circles(BlockRun& run, const CodeRule& rule) {
  const ProgramFrame& frame = run.state.frame;
  const PlaneAxes axes = axes_of(run.state.plane);
  const double first = std::fabs(frame.factors[static_cast<int>(index(axes.first))]);
  const double second = std::fabs(frame.factors[static_cast<int>(index(axes.second))]);
  if (!frame.scaled || std::fabs(first - second) <= 1e-12 * first) return true;
  run.error("frame_error", rule,
            std::string("G51 scales ") + letter(axes.first) + " by " + shortest(first) + " and " +
                letter(axes.second) + " by " + shortest(second) +
                ", which makes no circle of an arc; use one factor for both");
  return false;
}

}  // namespace

std::optional<PlanePoint> arc_centre(BlockRun& run, const CodeRule& rule, PlanePoint start,
                                     PlanePoint end) {
  if (!words_fit(run, rule)) return std::nullopt;
  const Point a{start.u, start.v}, b{end.u, end.v};
  const auto centre =
      run.has('R') ? centre_from_radius(run, rule, a, b) : centre_from_offsets(run, rule, a);
  if (!centre || (!run.has('R') && !radii_agree(run, rule, a, b, *centre))) return std::nullopt;
  return PlanePoint{centre->a, centre->b};
}

void arc(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (!words_fit(run, rule) || !feed_is_set(run, rule)) return;
  const auto target = target_of(run);
  if (!target) return;
  const PlaneAxes axes = axes_of(state.plane);
  const bool polar = run.has('@') || run.has('^');
  if (run.has('R') && !polar && !run.has(letter(axes.first)) && !run.has(letter(axes.second)))
    return run.error("arc_error", rule,
                     std::string("an arc with R needs its end point: ") + letter(axes.first) +
                         " or " + letter(axes.second));
  int turns = 1;
  if (run.has('P')) {
    const auto p = run.integer('P', 1, 1'000'000);
    if (!p) return;
    turns = *p;
  }

  const AxisValues start = to_program(state, state.programmed_tip());
  const AxisValues end = to_program(state, *target);
  const Point a{start[axes.first], start[axes.second]};
  const Point b{end[axes.first], end[axes.second]};
  const auto centre =
      run.has('R') ? centre_from_radius(run, rule, a, b) : centre_from_offsets(run, rule, a);
  if (!centre) return;
  if (!run.has('R') && !radii_agree(run, rule, a, b, *centre)) return;

  if (!keeps_circles(run, rule)) return;
  AxisValues middle = start;
  middle[axes.first] = centre->a;
  middle[axes.second] = centre->b;
  middle = to_tip(state, middle);
  PlannedMove move{PlannedMove::Kind::arc, *target, {}};
  // An end that is the start but for rounding means a full circle.
  AxisSet plane, depth;
  plane.add(axes.first);
  plane.add(axes.second);
  depth.add(axes.normal);
  const bool aligned = moved_by(state, depth) == depth;
  if (aligned && distance(b.a - a.a, b.b - a.b) < 1e-9)
    for (const Axis axis : all_axes)
      if (moved_by(state, plane).has(axis)) move.end[axis] = state.programmed_tip()[axis];
  move.arc.end = move.end;
  move.arc.centre = Vec3(middle[Axis::x], middle[Axis::y], middle[Axis::z]);
  move.arc.normal = plane_normal(state);
  move.arc.turns = (rule.code == 30) != swaps_sides(state) ? turns : -turns;
  move.arc.plane = state.plane;
  if (state.feed_mode == canon::FeedMode::inverse_time)
    move.rate = note_inverse_time(run, canon::arc_way(state.programmed_tip(), move.arc));
  make_move(run, rule, move);
}

}  // namespace aircut::interp
