// Moves that wait for the next one (held_move.h): what is held, when it goes on, and the way
// between program coordinates in the plane, in which corners are cut, and positions of the tool.
#include "interp/held_move.h"

#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

constexpr double tiny = 1e-9;  // mm

PlanePoint in_plane(const ModalState& state, const AxisValues& tip) {
  const PlaneAxes axes = axes_of(state.plane);
  const AxisValues program = to_program(state, tip);
  return {program[axes.first], program[axes.second]};
}

// The tip there in the plane; all else as in `like`.
AxisValues tip_in_plane(const ModalState& state, const AxisValues& like, PlanePoint at) {
  const PlaneAxes axes = axes_of(state.plane);
  AxisValues program = to_program(state, like);
  program[axes.first] = at.u;
  program[axes.second] = at.v;
  const AxisValues tip = to_tip(state, program);
  AxisSet named;
  named.add(axes.first);
  named.add(axes.second);
  AxisValues result = like;
  for (const Axis axis : all_axes)
    if (moved_by(state, named).has(axis)) result[axis] = tip[axis];
  return result;
}

ContourPiece piece_of(const ModalState& state, const AxisValues& from, const PlannedMove& move) {
  ContourPiece piece;
  piece.start = in_plane(state, from);
  piece.end = in_plane(state, move.end);
  if (move.kind != PlannedMove::Kind::arc) return piece;
  AxisValues centre = from;
  for (int i = 0; i < 3; ++i) centre.value[static_cast<std::size_t>(i)] = move.arc.centre[i];
  piece.centre = in_plane(state, centre);
  piece.turn = (move.arc.turns > 0) != swaps_sides(state) ? 1 : -1;
  return piece;
}

void end_at(const ModalState& state, PlannedMove& move, PlanePoint at) {
  move.end = tip_in_plane(state, move.end, at);
  move.arc.end = move.end;
}

PlannedMove move_of(const ModalState& state, const ContourPiece& piece, const AxisValues& like) {
  PlannedMove move;
  move.end = tip_in_plane(state, like, piece.end);
  if (piece.turn == 0) return move;
  const AxisValues centre = tip_in_plane(state, like, piece.centre);
  move.kind = PlannedMove::Kind::arc;
  move.arc.end = move.end;
  move.arc.centre = Vec3(centre[Axis::x], centre[Axis::y], centre[Axis::z]);
  move.arc.normal = plane_normal(state);
  move.arc.turns = (piece.turn > 0) != swaps_sides(state) ? 1 : -1;
  move.arc.plane = state.plane;
  return move;
}

// A corner lies in the plane: no other axis moves in its two blocks.
std::optional<Axis> moves_out_of_plane(const ModalState& state, const AxisValues& from,
                                       const AxisValues& to) {
  const PlaneAxes axes = axes_of(state.plane);
  const AxisValues a = to_program(state, from), b = to_program(state, to);
  for (const Axis axis : all_axes)
    if (axis != axes.first && axis != axes.second && std::fabs(a[axis] - b[axis]) > tiny)
      return axis;
  return std::nullopt;
}

}  // namespace

void deliver(BlockRun& run, const PlannedMove& move) {
  ModalState& state = run.state;
  if (state.comp.side != CompSide::off || state.comp.leaving)
    return run.session.compensator.move(run, move);
  if (move.kind == PlannedMove::Kind::rapid)
    run.emit(canon::Rapid{move.end});
  else if (move.kind == PlannedMove::Kind::feed)
    run.emit(canon::LinearFeed{move.end});
  else
    run.emit(move.arc);
  state.tip = move.end;
}

namespace {

void hold(BlockRun& run, HeldMove held) {
  ModalState& state = run.state;
  held.from = state.programmed_tip();
  held.head = run.head();
  held.tip_before = state.tip;
  held.programmed_before = state.comp.programmed;
  if (state.comp.entered)
    state.comp.programmed = held.move.end;
  else
    state.tip = held.move.end;
  run.session.held = std::move(held);
}

// The held move and what has waited for it, with `corner` between.
void let_go(BlockRun& run, HeldMove& held, const PlannedMove* corner) {
  run.state.tip = held.tip_before;
  run.state.comp.programmed = held.programmed_before;
  run.speak_for(&held.head);
  deliver(run, held.move);
  if (corner && run.ok()) deliver(run, *corner);
  run.speak_for(nullptr);
  for (canon::Command& command : held.waiting) run.pass_on(std::move(command));
}

// The end of a line by its angle is where it meets the line of this block.
bool close_open_line(BlockRun& run, const CodeRule& rule, HeldMove& held, const PlannedMove& next) {
  const auto angle = line_angle(run);
  const bool absolute = run.has('X') && run.has('Z');
  if (rule.code != 10 || !angle || !absolute)
    return run.fail_corner(
        "behind a line with an angle alone stands one with X, Z and an angle of its own");
  const auto meet = meeting_point(in_plane(run.state, held.from), *held.angle,
                                  in_plane(run.state, next.end), *angle);
  if (!meet) return run.fail_corner("the two lines are parallel, so they meet nowhere");
  end_at(run.state, held.move, *meet);
  return true;
}

// Cuts the corner between the held move and this one, and makes the held one.
bool resolve(BlockRun& run, const CodeRule& rule, HeldMove& held, const PlannedMove& next) {
  ModalState& state = run.state;
  if (held.angle && !close_open_line(run, rule, held, next)) return false;
  if (held.corner.word.kind == CornerWord::Kind::none) {
    let_go(run, held, nullptr);
    return run.ok();
  }
  const DialectTraits& control = run.session.table.dialect();
  const bool arcs = held.move.kind == PlannedMove::Kind::arc || next.kind == PlannedMove::Kind::arc;
  if (arcs && !control.arc_corners)
    return run.fail_corner(std::string(control.name) + " makes corners between lines only");
  if (const auto axis = moves_out_of_plane(state, held.move.end, next.end))
    return run.fail_corner(std::string("a corner lies in the plane in force, but ") +
                           letter(*axis) + " moves in the next block");
  const ContourPiece before = piece_of(state, held.from, held.move);
  const ContourPiece after = piece_of(state, held.move.end, next);
  if (after.turn == 0 &&
      std::hypot(after.end.u - after.start.u, after.end.v - after.start.v) < tiny)
    return run.fail_corner("the next block has no way in the plane, so there is no corner");
  std::string doubt;
  if (const auto problem = corner_problem(held.corner, before, after, doubt))
    return run.fail_corner(*problem);
  if (!doubt.empty()) run.warning("control_setting", run.whole(), "the corner in front: " + doubt);
  if (runs_straight_on(before, after)) {
    let_go(run, held, nullptr);
    return run.ok();
  }
  const auto cut = cut_corner(before, after, held.corner.word);
  if (!cut)
    return run.fail_corner("the corner " + written(held.corner.letter) +
                           shortest(held.corner.word.size / state.unit_mm()) +
                           " does not fit on its two moves; use a smaller one");
  const PlannedMove corner = move_of(state, *cut, held.move.end);
  end_at(state, held.move, cut->start);
  let_go(run, held, &corner);
  return run.ok();
}

void hold_open_line(BlockRun& run, double angle) {
  if (run.session.held)
    return static_cast<void>(
        run.fail_corner("behind a line with an angle alone stands one with X, Z and an angle"));
  const CodeRule& rule = *run.motion_rule;
  HeldMove held;
  held.corner = corner_request(run, rule);
  if (!run.ok()) return;
  held.move.end = run.state.programmed_tip();
  held.angle = angle;
  held.place = run.has('a') ? run.place('a') : run.place('A');
  hold(run, std::move(held));
}

bool corner_is_possible(BlockRun& run, const CornerRequest& request, const PlannedMove& move) {
  const ModalState& state = run.state;
  const PlaneAxes axes = axes_of(state.plane);
  const auto scaled = [&](Axis axis) {
    return state.frame.scaled && std::fabs(state.frame.factors[static_cast<int>(index(axis))]) != 1;
  };
  const char word = request.letter;
  if (state.polar.on)
    run.error("corner_error", word, "corners can't be given between G16 and G15");
  else if (scaled(axes.first) || scaled(axes.second))
    run.error("corner_error", word,
              "whether G51 scales " + written(word) +
                  " too is not known here; give the corner's own moves");
  else if (run.machine_coordinates)
    run.error("corner_error", word, "corners can't be given with G53");
  else if (const auto axis = moves_out_of_plane(state, state.programmed_tip(), move.end))
    run.error("corner_error", word,
              std::string("a corner lies in the plane in force; ") + letter(*axis) +
                  " can't move in its block");
  else if (in_plane(state, state.programmed_tip()).u == in_plane(state, move.end).u &&
           in_plane(state, state.programmed_tip()).v == in_plane(state, move.end).v &&
           move.kind != PlannedMove::Kind::arc)
    run.error("corner_error", word, "this block has no way in the plane, so it has no corner");
  return run.ok();
}

}  // namespace

bool is_free(const BlockRun& run) {
  const CompState& comp = run.state.comp;
  return !run.session.held && !run.session.table.dialect().macro_b && comp.side == CompSide::off &&
         !comp.leaving;
}

void make_move(BlockRun& run, const CodeRule& rule, const PlannedMove& move) {
  if (is_free(run)) return deliver(run, move);
  if (run.session.held) {
    HeldMove held = std::move(*run.session.held);
    run.session.held.reset();
    if (!resolve(run, rule, held, move)) return;
  }
  const CornerRequest request = corner_request(run, rule);
  if (!run.ok()) return;
  if (request.word.kind == CornerWord::Kind::none) return deliver(run, move);
  if (!corner_is_possible(run, request, move)) return;
  HeldMove held;
  held.move = move;
  held.corner = request;
  held.place = run.place(request.letter);
  hold(run, std::move(held));
}

// A line with X or Z and its angle, or with the angle alone.
void line_by_angle(const CodeRule& rule, BlockRun& run, double angle) {
  const ModalState& state = run.state;
  const Place place = run.has('a') ? run.place('a') : run.place('A');
  const bool x = run.has('X') || run.has('U'), z = run.has('Z') || run.has('W');
  const bool behind_open = run.session.held && run.session.held->angle;
  if (state.plane != canon::Plane::zx)
    return run.error("corner_error", place, "the angle of a line counts in the ZX plane; give G18");
  if (!x && !z) {
    if (run.session.options.dialect == Dialect::fanuc) return hold_open_line(run, angle);
    return run.error("word_missing", place, "a line by its angle needs X or Z too");
  }
  if (x && z && !behind_open)
    return run.error(
        "corner_error", place,
        "X and Z give the end of the line already; leave the angle or one of them out");
  const auto target = target_of(run);
  if (!target) return;
  PlannedMove move{PlannedMove::Kind::feed, *target, {}};
  if (!(x && z)) {
    if (behind_open)
      return static_cast<void>(
          run.fail_corner("behind a line with an angle alone stands one with X, Z and an angle"));
    const PlanePoint named = in_plane(state, *target);
    const auto end = end_under_angle(in_plane(state, state.programmed_tip()), angle,
                                     z ? std::optional(named.u) : std::nullopt,
                                     x ? std::optional(named.v) : std::nullopt);
    if (!end)
      return run.error("corner_error", place,
                       std::string("a line under this angle never reaches the ") + (x ? "X" : "Z") +
                           " of its end");
    end_at(state, move, *end);
  }
  make_move(run, rule, move);
}

bool may_follow_corner(const Block& block, const ModalState& state) {
  if (block.words.empty()) return true;
  int motion = state.motion;
  bool dwells = false;
  for (const Word& word : block.words) {
    if (word.letter != 'G' && word.letter != 'M') continue;
    if (!word.rule) return true;  // an error of its own
    switch (word.rule->group) {
      case ModalGroup::motion:
        motion = word.rule->code;
        break;
      case ModalGroup::distance:
      case ModalGroup::feed_mode:
      case ModalGroup::control:
      case ModalGroup::spindle:
      case ModalGroup::spindle_mode:
      case ModalGroup::coolant:
      case ModalGroup::free:
        break;
      case ModalGroup::stop:
        if (word.rule->handler != program_stop) return false;
        break;
      case ModalGroup::non_modal:
        if (word.rule->handler != fanuc_dwell) return false;
        dwells = true;
        break;
      default:
        return false;
    }
  }
  if (dwells) return true;
  constexpr std::uint32_t moves =
      axis_letters | letter_bit('a') | letter_bit('I') | letter_bit('J') | letter_bit('K');
  return motion >= 10 && motion <= 30 && (block.letters & moves) != 0;
}

void release_held(BlockRun& run) {
  if (!run.session.held) return;
  HeldMove held = std::move(*run.session.held);
  run.session.held.reset();
  if (!held.angle) return let_go(run, held, nullptr);
  run.state.tip = held.tip_before;
  run.state.comp.programmed = held.programmed_before;
  for (canon::Command& command : held.waiting) run.pass_on(std::move(command));
}

}  // namespace aircut::interp
