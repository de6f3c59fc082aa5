// Cutter radius compensation in the plane (a, b) of G17 or G18, seen from the tip of its normal.
//
// The tool's centre runs beside the contour at the distance r: offset = end + r·n, where n is the
// contour's unit normal on the tool's side (left for G41). β is the angle from the normal at the
// end of one element to the normal at the start of the next, positive where the contour turns away
// from the tool:
//
//   β > 0.05 rad   outside corner: an arc of radius r about the programmed corner
//   |β| <= 0.05    straight on: nothing is put in
//   β < −0.05      inside corner: both offset elements end where they cross (line or circle with
//                  line or circle); without a crossing, or when an element would have to run
//                  backwards, the tool does not fit
//
//        n₁│        contour ────●╮ outside: the arc runs round the corner ●
//   ═══════╪═══╗                │╰╮
//   ───────┘   ║    inside: the offset lines cross at ╝ before the corner
//
// Look-ahead is one element: the last one is held back with whatever follows it (Z moves, dwells),
// until the next element in the plane says where it ends. A lathe tool with a nose (orientation
// 1-8) is guided at the corner of the box round its nose, a constant shift from the nose's centre.
#include "interp/compensation.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/dialect.h"
#include "interp/run.h"

namespace aircut::interp {
namespace {

constexpr double corner_angle = 0.05;  // rad, of the reference
constexpr double same_point = 1e-9;    // mm
constexpr double touching = 1e-9;      // mm², of circles and lines that touch but for rounding

bool is_fanuc(const BlockRun& run) { return run.session.table.dialect().macro_b; }

std::string mm(double value) { return fixed(value, 4) + " mm"; }

}  // namespace

// ---- frames ----------------------------------------------------------------------------------

Compensator::Point Compensator::point_of(const ModalState& state, const AxisValues& tip) const {
  const AxisValues work = to_work(state, tip);
  const PlaneAxes axes = axes_of(state.plane);
  return {work[axes.first], work[axes.second]};
}

// From the centre of the nose to the guided point, in the ZX plane: a is Z, b is X.
Compensator::Point Compensator::nose_shift(const ModalState& state) const {
  const int o = state.comp.orientation;
  const double r = state.comp.radius;
  Point shift;
  if (state.plane != canon::Plane::zx) return shift;
  if (o == 1 || o == 2 || o == 6) shift.b = -r;
  if (o == 3 || o == 4 || o == 8) shift.b = r;
  if (o == 2 || o == 3 || o == 7) shift.a = -r;
  if (o == 1 || o == 4 || o == 5) shift.a = r;
  return shift;
}

// While a nose runs beside the contour the control tells where its centre is, not its tip.
AxisValues Compensator::told_position(const ModalState& state) const {
  if (state.comp.side == CompSide::off || !state.comp.entered) return state.tip;
  const Point shift = nose_shift(state);
  if (shift.a == 0 && shift.b == 0) return state.tip;
  return tip_of(state, state.tip, point_of(state, state.tip) - 2 * shift);
}

// The tip of a tool whose (nose's) centre is there; all else as in `like`.
AxisValues Compensator::tip_of(const ModalState& state, const AxisValues& like,
                               Point centre) const {
  const Point guided = centre + nose_shift(state);
  AxisValues work = to_work(state, like);
  const PlaneAxes axes = axes_of(state.plane);
  work[axes.first] = guided.a;
  work[axes.second] = guided.b;
  AxisValues tip = work_to_tip(state, work);
  for (const Axis axis : all_axes) {
    const bool moves =
        axis == axes.first || axis == axes.second || (state.rotation != 0 && axis <= Axis::y);
    if (!moves) tip[axis] = like[axis];
  }
  return tip;
}

// The tool's radius is not scaled, so all of this happens behind the program's frame; there a
// mirror has changed sides.
double Compensator::side_sign(const ModalState& state) const {
  return (state.comp.side == CompSide::left) != swaps_sides(state) ? 1 : -1;
}

// ---- the moves -------------------------------------------------------------------------------

void Compensator::start() {
  held_.clear();
  last_.reset();
}

void Compensator::flush(BlockRun& run) {
  for (canon::Command& command : held_) run.release(std::move(command));
  held_.clear();
}

// G40, M2: the last move must still run forward from where its corner has put its start.
void Compensator::finish(BlockRun& run) {
  if (!held_.empty() && last_ && runs_back(*last_))
    return run.error("comp_gouge", run.whole(),
                     "the tool with radius " + mm(run.state.comp.radius) +
                         " does not fit: the last move is too short behind its corner");
  flush(run);
}

bool Compensator::excuse_held() {
  if (held_.empty() || !last_ || !runs_back(*last_)) return false;
  last_->excused = true;
  return true;
}

void Compensator::leave(BlockRun& run, const PlannedMove& planned) {
  ModalState& state = run.state;
  if (planned.kind == PlannedMove::Kind::arc)
    return run.error("comp_illegal", run.whole(),
                     "the first move after radius compensation (G40) must be straight, not an arc");
  const double length =
      norm(point_of(state, planned.end) - point_of(state, state.programmed_tip()));
  if (planned.kind == PlannedMove::Kind::rapid)
    run.warning("comp_rapid", run.whole(),
                "radius compensation ends on a rapid, which runs obliquely off the contour; leave "
                "it with G1, then retract");
  else if (length < 2 * state.comp.radius)
    run.warning("comp_exit_short", run.whole(),
                "the move that leaves radius compensation is shorter than the tool's diameter (" +
                    mm(2 * state.comp.radius) + "); it may cut into the contour");
  if (const auto rate = pace(planned, canon::straight_way(state.comp.left_at, planned.end)))
    run.emit(*rate);
  state.comp = CompState{};
  state.tip = planned.end;
  if (planned.kind == PlannedMove::Kind::rapid)
    run.emit(canon::Rapid{planned.end});
  else
    run.emit(canon::LinearFeed{planned.end});
}

// A move before compensation has begun.
void Compensator::plain(BlockRun& run, const PlannedMove& planned) {
  run.state.tip = planned.end;
  if (planned.kind == PlannedMove::Kind::rapid)
    run.emit(canon::Rapid{planned.end});
  else
    run.emit(canon::LinearFeed{planned.end});
}

// A move without way in the plane: the corner stays open.
void Compensator::stay(BlockRun& run, const PlannedMove& planned) {
  ModalState& state = run.state;
  const AxisValues end = tip_of(state, planned.end, point_of(state, state.tip) - nose_shift(state));
  state.comp.programmed = planned.end;
  state.tip = end;
  if (planned.kind == PlannedMove::Kind::rapid)
    run.emit(canon::Rapid{end});
  else
    run.emit(canon::LinearFeed{end});
}

void Compensator::move(BlockRun& run, const PlannedMove& planned) {
  ModalState& state = run.state;
  if (state.comp.side == CompSide::off) return leave(run, planned);
  const Point to = point_of(state, planned.end);
  const bool is_arc = planned.kind == PlannedMove::Kind::arc;
  if (!state.comp.entered) {
    // On Fanuc the first move in the plane begins it.
    const bool any_length = is_fanuc(run) || state.comp.radius < same_point;
    if (any_length && !is_arc && norm(to - point_of(state, state.tip)) < same_point)
      return plain(run, planned);
    const Point from = point_of(state, state.tip);
    auto path = entry_path(run, planned, from, to);
    if (!path) return;
    state.comp.entered = true;
    if (planned.kind == PlannedMove::Kind::rapid)
      run.warning("comp_rapid", run.whole(),
                  "radius compensation begins on a rapid, which runs obliquely to the contour; "
                  "begin it with G1");
    emit_path(run, planned, *path);
    return;
  }
  const Point from = point_of(state, state.comp.programmed);
  if (!is_arc && norm(to - from) < same_point) return stay(run, planned);
  auto path = next_path(run, planned, from, to);
  if (!path) return;
  if (!join(run, planned, *path, from)) return;
  emit_path(run, planned, *path);
}

std::optional<Compensator::Path> Compensator::entry_path(BlockRun& run, const PlannedMove& planned,
                                                         Point from, Point to) {
  const ModalState& state = run.state;
  const double r = state.comp.radius;
  const double side = side_sign(state);
  Path path;
  path.entry = true;
  path.start = from;
  if (planned.kind != PlannedMove::Kind::arc) {
    const double length = norm(to - from);
    if (length <= (is_fanuc(run) ? same_point : r)) {
      run.error("comp_entry", run.whole(),
                "the move that begins radius compensation is " + mm(length) +
                    " long in the plane; it must be longer than the tool's radius " + mm(r));
      return std::nullopt;
    }
    const Point along = (1 / length) * (to - from);
    path.direction = along;
    path.end_normal = {-side * along.b, side * along.a};
    path.start_normal = path.end_normal;
    path.end = to + r * path.end_normal;
    // The tool runs obliquely to the offset point.
    path.direction = path.end - from;
    return path;
  }
  if (is_fanuc(run)) {
    run.error("comp_entry", run.whole(),
              "radius compensation begins with a straight move, not with an arc");
    return std::nullopt;
  }
  const Point nose = nose_shift(state);
  if (nose.a != 0 || nose.b != 0) {
    // The control goes straight to the arc's end, and round a full circle there or not at all.
    run.error("comp_entry", run.whole(),
              "radius compensation of a lathe tool with orientation " +
                  std::to_string(state.comp.orientation) +
                  " begins with a straight move, not with an arc");
    return std::nullopt;
  }
  AxisValues middle = planned.end;
  for (int i = 0; i < 3; ++i) middle.value[static_cast<std::size_t>(i)] = planned.arc.centre[i];
  const Point centre = point_of(state, middle);
  const double radius = norm(to - centre);
  if (radius <= r) {
    run.error("comp_entry", run.whole(),
              "the arc that begins radius compensation has the radius " + mm(radius) +
                  "; it must be larger than the tool's radius " + mm(r));
    return std::nullopt;
  }
  path.is_arc = true;
  path.left_turn = planned.arc.turns > 0;
  const Point outward = (1 / radius) * (to - centre);
  path.end_normal = (path.left_turn ? -side : side) * outward;
  path.end = to + r * path.end_normal;
  if (r < same_point) {  // a full circle too
    path.centre = centre;
    path.radius = radius;
    path.sweep = sweep_of(path);
    return path;
  }
  // Tangent at its end: the new centre lies on the normal there, as far from the start as from the
  // end. With d = start − end and u the unit vector from the end to the old centre:
  // |d − t·u| = t, so t = d² / (2 d·u).
  const Point d = from - path.end;
  const Point u = -1.0 * outward;
  const double t = dot(d, u) > 1e-12 ? dot(d, d) / (2 * dot(d, u)) : 0;
  if (t <= 0) {
    run.error("comp_entry", run.whole(),
              "no arc leads from here to the start of the compensated contour; begin with a line");
    return std::nullopt;
  }
  path.centre = path.end + t * u;
  path.radius = t;
  path.sweep = sweep_of(path);
  return path;
}

std::optional<Compensator::Path> Compensator::next_path(BlockRun& run, const PlannedMove& planned,
                                                        Point from, Point to) {
  const ModalState& state = run.state;
  const double r = state.comp.radius;
  const double side = side_sign(state);
  Path path;
  if (planned.kind != PlannedMove::Kind::arc) {
    const Point along = (1 / norm(to - from)) * (to - from);
    path.direction = along;
    path.start_normal = path.end_normal = {-side * along.b, side * along.a};
  } else {
    AxisValues middle = planned.end;
    for (int i = 0; i < 3; ++i) middle.value[static_cast<std::size_t>(i)] = planned.arc.centre[i];
    path.is_arc = true;
    path.left_turn = planned.arc.turns > 0;
    path.centre = point_of(state, middle);
    const double radius = norm(to - path.centre);
    const double outward = path.left_turn ? -side : side;  // +1: the tool runs outside the arc
    if (outward < 0 && radius <= r + same_point) {
      run.error("comp_arc", run.whole(),
                "the tool with radius " + mm(r) + " does not fit inside this arc of radius " +
                    mm(radius));
      return std::nullopt;
    }
    path.radius = radius + outward * r;
    path.start_normal = (outward / norm(from - path.centre)) * (from - path.centre);
    path.end_normal = (outward / radius) * (to - path.centre);
  }
  path.start = from + r * path.start_normal;
  path.end = to + r * path.end_normal;
  if (path.is_arc) path.sweep = sweep_of(path);
  return path;
}

// ---- corners ---------------------------------------------------------------------------------

// Puts the corner between the held element and the next one in order and lets go of the held one.
bool Compensator::join(BlockRun& run, const PlannedMove& planned, Path& next, Point corner) {
  ModalState& state = run.state;
  if (last_->entry && is_fanuc(run)) {  // straight to beside the corner, as start-up type A
    end_held_at(run, next.start);
    flush(run);
    return true;
  }
  const double side = side_sign(state);
  const Point before = last_->end_normal;
  double beta =
      -side * std::atan2(cross(before, next.start_normal), dot(before, next.start_normal));
  // Turning back counts as an outside corner, up to a little more than half a turn; before an arc
  // with the tool on its outside, and between such an arc and a line, to a little less, as both
  // cross behind the corner.
  const Path& arc = next.is_arc ? next : *last_;
  const bool bends_back = arc.is_arc && arc.left_turn == (side < 0);
  const double most = std::numbers::pi + (bends_back ? -corner_angle : corner_angle);
  if (beta < most - 2 * std::numbers::pi) beta += 2 * std::numbers::pi;
  if (beta > most) beta -= 2 * std::numbers::pi;
  if (state.comp.radius < same_point) beta = 0;
  if (beta < -corner_angle) {
    if (!meet_inside(run, next, corner)) return false;
    flush(run);
    return true;
  }
  if (runs_back(*last_)) {
    run.error("comp_gouge", run.whole(),
              "the tool with radius " + mm(state.comp.radius) +
                  " does not fit: the move before this one is too short between its corners");
    return false;
  }
  flush(run);
  if (beta <= corner_angle) {
    next.start = last_->end;
    return true;
  }
  // Along the normal the corner stays level; all other axes turn with it, as on the control.
  AxisValues middle = tip_of(state, state.tip, next.start);
  if (!is_fanuc(run))
    for (const Axis axis : all_axes)
      if (axis > Axis::z) middle[axis] = planned.end[axis];
  if (planned.kind == PlannedMove::Kind::rapid) {
    run.emit_now(canon::Rapid{middle}, "corner of radius compensation");
  } else {
    canon::ArcFeed round;
    round.end = middle;
    const AxisValues centre = tip_of(state, state.tip, corner);
    round.centre = Vec3(centre[Axis::x], centre[Axis::y], centre[Axis::z]);
    round.normal = plane_normal(state);
    round.turns = side > 0 ? -1 : 1;
    round.plane = state.plane;
    if (const auto rate = pace(planned, canon::arc_way(state.tip, round))) run.emit_now(*rate);
    run.emit_now(round, "corner of radius compensation");
  }
  state.tip = middle;
  return true;
}

// Both elements end where they cross; of two crossings the one nearer to the corner counts.
bool Compensator::meet_inside(BlockRun& run, Path& next, Point corner) {
  const auto misfit = [&](const std::string& why) {
    run.error("comp_gouge", run.whole(),
              "the tool with radius " + mm(run.state.comp.radius) +
                  " does not fit into this inside corner: " + why);
    return false;
  };
  std::vector<Point> crossings = intersections(*last_, next);
  if (crossings.empty()) return misfit("the compensated moves do not meet");
  // A crossing behind the end of the old element would lengthen it.
  const auto shortens = [&](Point p) {
    if (!last_->is_arc) return dot(p - last_->end, last_->direction) <= same_point;
    Path cut = *last_;
    cut.end = p;
    return still_forward(cut);
  };
  if (std::any_of(crossings.begin(), crossings.end(), shortens))
    std::erase_if(crossings, [&](Point p) { return !shortens(p); });
  const Point at = *std::min_element(crossings.begin(), crossings.end(), [&](Point p, Point q) {
    return norm(p - corner) < norm(q - corner);
  });
  Path shortened = *last_;
  shortened.end = at;
  if (!still_forward(shortened)) return misfit("the move before it is too short");
  next.start = at;
  end_held_at(run, at);
  return true;
}

// The held element ends there; so does what is held behind it.
void Compensator::end_held_at(BlockRun& run, Point at) {
  for (canon::Command& command : held_) {
    std::visit(
        overloaded{[&](canon::Rapid& c) { c.end = tip_of(run.state, c.end, at); },
                   [&](canon::LinearFeed& c) { c.end = tip_of(run.state, c.end, at); },
                   [&](canon::ArcFeed& c) { c.end = tip_of(run.state, c.end, at); }, [](auto&) {}},
        command.action);
  }
  last_->end = at;
  if (held_rate_ <= 0 || held_.size() < 2) return;
  auto* rate = std::get_if<canon::SetFeedRate>(&held_[0].action);
  const auto* line = std::get_if<canon::LinearFeed>(&held_[1].action);
  const auto* arc = std::get_if<canon::ArcFeed>(&held_[1].action);
  if (!rate || (!line && !arc)) return;
  const canon::Way way =
      line ? canon::straight_way(held_start_, line->end) : canon::arc_way(held_start_, *arc);
  if (way.length > 0) rate->value = held_rate_ / way.length;
}

// In inverse time the control takes the rate from the contour as programmed: the compensated move
// and the corner before it are driven at that speed.
std::optional<canon::SetFeedRate> Compensator::pace(const PlannedMove& planned,
                                                    canon::Way way) const {
  if (planned.rate <= 0 || way.length <= 0 || way.rotary) return std::nullopt;
  canon::SetFeedRate rate;
  rate.value = planned.rate / way.length;
  return rate;
}

// The angle that an arc runs through, in its own turning direction, from 0 to 2π.
double Compensator::sweep_of(const Path& arc) const {
  const Point p = arc.start - arc.centre, q = arc.end - arc.centre;
  const double left = std::atan2(cross(p, q), dot(p, q));
  double sweep = arc.left_turn ? left : -left;
  if (sweep <= 1e-12) sweep += 2 * std::numbers::pi;
  return sweep;
}

// True when a path whose start or end was moved still runs in its own direction.
bool Compensator::still_forward(const Path& path) const {
  const Point way = path.end - path.start;
  if (!path.is_arc) return dot(way, path.direction) >= -same_point;
  return sweep_of(path) <= path.sweep + corner_angle;
}

// True when the corners at both ends of a path have swallowed it. An arc then runs nearly once more
// round; a joint that is almost straight lengthens it a little.
bool Compensator::runs_back(const Path& path) const {
  if (path.excused) return false;
  if (!path.is_arc) return !still_forward(path);
  if (norm(path.end - path.start) < same_point) return false;
  return sweep_of(path) > path.sweep + std::numbers::pi;
}

std::vector<Compensator::Point> Compensator::intersections(const Path& first,
                                                           const Path& second) const {
  if (!first.is_arc && !second.is_arc) {
    const Point u{first.end_normal.b, -first.end_normal.a};
    const Point v{second.start_normal.b, -second.start_normal.a};
    const double det = cross(u, v);
    if (std::fabs(det) < 1e-12) return {};
    return {first.end + (cross(second.start - first.end, v) / det) * u};
  }
  if (first.is_arc && second.is_arc) {
    const Point d = second.centre - first.centre;
    const double length = norm(d);
    if (length < same_point) return {};
    const double along =
        (length * length + first.radius * first.radius - second.radius * second.radius) /
        (2 * length);
    const double square = first.radius * first.radius - along * along;
    if (square < -touching) return {};
    const Point e = (1 / length) * d;
    const Point foot = first.centre + along * e;
    const double h = std::sqrt(std::max(0.0, square));
    return {foot + h * Point{-e.b, e.a}, foot - h * Point{-e.b, e.a}};
  }
  const Path& arc = first.is_arc ? first : second;
  const Point on_line = first.is_arc ? second.start : first.end;
  const Point normal = first.is_arc ? second.start_normal : first.end_normal;
  const Point along{normal.b, -normal.a};
  const double distance = dot(arc.centre - on_line, normal);
  const double square = arc.radius * arc.radius - distance * distance;
  if (square < -touching) return {};
  const Point foot = arc.centre - distance * normal;
  const double h = std::sqrt(std::max(0.0, square));
  return {foot + h * along, foot - h * along};
}

// The move becomes the held one.
void Compensator::emit_path(BlockRun& run, const PlannedMove& planned, const Path& path) {
  ModalState& state = run.state;
  const AxisValues end = tip_of(state, planned.end, path.end);
  held_start_ = path.entry ? state.tip : tip_of(state, state.tip, path.start);
  held_rate_ = planned.rate;
  switch (planned.kind) {
    case PlannedMove::Kind::rapid:
      run.emit_held(canon::Rapid{end});
      break;
    case PlannedMove::Kind::feed:
      if (const auto rate = pace(planned, canon::straight_way(held_start_, end)))
        run.emit_held(*rate);
      run.emit_held(canon::LinearFeed{end});
      break;
    case PlannedMove::Kind::arc: {
      canon::ArcFeed arc = planned.arc;
      arc.end = end;
      const AxisValues centre = tip_of(state, state.tip, path.centre);
      arc.centre = Vec3(centre[Axis::x], centre[Axis::y], centre[Axis::z]);
      if (const auto rate = pace(planned, canon::arc_way(held_start_, arc))) run.emit_held(*rate);
      run.emit_held(arc);
      break;
    }
  }
  last_ = path;
  if (state.comp.radius < same_point) flush(run);  // no corner will move its end
  state.comp.programmed = planned.end;
  state.tip = end;
}

}  // namespace aircut::interp
