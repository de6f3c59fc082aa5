// G0 G1, G80, the synchronised moves G33 G33.1 and probing G38.x; where axis words lead.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/held_move.h"

namespace aircut::interp {
// @ is the distance from the origin of the program, ^ the angle (interp.md 8). A missing part keeps
// that of the current point; with G91 both are added to it.
bool apply_polar(BlockRun& run, double& x, double& y) {
  const ModalState& state = run.state;
  const char first = run.has('@') ? '@' : '^';
  if (run.plane_before != canon::Plane::xy) {
    run.error("polar_error", first,
              "polar words (@ ^) need the XY plane; give G17 on a line before");
    return false;
  }
  if (run.has('X') || run.has('Y')) {
    run.error("polar_error", run.has('X') ? 'X' : 'Y',
              "X and Y can't be given together with polar words (@ ^); use one of both");
    return false;
  }
  if (run.machine_coordinates) {
    run.error("polar_error", first, "polar words (@ ^) can't be used with G53; give X and Y");
    return false;
  }
  double radius = std::hypot(x, y);
  if (radius == 0 && (!run.has('^') || state.incremental)) {
    run.error("polar_error", first, "at the origin the angle is not defined; give ^ with G90");
    return false;
  }
  double angle = std::atan2(y, x);
  if (const auto r = run.number('@'))
    radius = *r * state.unit_mm() + (state.incremental ? radius : 0);
  if (const auto a = run.number('^'))
    angle = *a * radian_per_degree + (state.incremental ? angle : 0);
  x = radius * std::cos(angle);
  y = radius * std::sin(angle);
  return true;
}

namespace {

std::optional<AxisValues> machine_target(BlockRun& run) {
  const ModalState& state = run.state;
  AxisValues tip = state.tip;
  for (const Axis axis : all_axes)
    if (const auto value = run.axis(axis))  // that of rotary axes the control leaves out
      tip[axis] = *value - (is_rotary(axis) ? 0 : state.length_offset[axis]);
  return tip;
}

}  // namespace

bool spindle_turns(BlockRun& run, const CodeRule& rule, int spindle) {
  if (run.state.spindles[static_cast<std::size_t>(spindle)].turn != canon::SpindleTurn::stop)
    return true;
  run.error("spindle_stopped", rule,
            name_of(rule) + " needs a turning spindle; give M3 or M4 before");
  return false;
}

namespace {

std::optional<AxisValues> named_target(BlockRun& run) {
  const ModalState& state = run.state;
  if (run.machine_coordinates && run.motion_rule && !run.has('@') && !run.has('^'))
    return machine_target(run);
  if (state.length_suspended && run.motion_rule && run.has('Z')) {
    run.warning(
        "control_setting", run.place('Z'),
        "G28, G30 or G53 has taken the tool length offset away, and whether it comes back by "
        "itself depends on a parameter of the control; give G43 H again");
    run.state.length_suspended = false;
  }
  const AxisValues& start = state.programmed_tip();
  const bool polar = run.has('@') || run.has('^');
  if (state.rotation == 0 && !state.frame.active() && !state.turn_was_left && !polar &&
      !state.polar.on) {
    std::optional<AxisValues> target(start);  // filled in where it is handed out
    AxisValues& tip = *target;
    const bool lathe = run.session.table.lathe();
    if (lathe)
      for (const Axis axis : {Axis::x, Axis::y, Axis::z})
        if (const auto by = run.increment(axis)) tip[axis] += *by;
    for (const Word& word : run.block.words) {
      if (!(letter_bit(word.letter) & axis_letters)) continue;
      const Axis axis = *axis_of_letter(word.letter);
      if (lathe && !run.is_axis(axis)) continue;
      const double value = run.axis_number(word, axis);
      tip[axis] =
          state.incremental ? tip[axis] + value : value + state.g92[axis] + state.work_offset[axis];
    }
    return target;
  }
  AxisValues program = to_program(state, start);
  AxisSet named;
  for (const Axis axis : all_axes) {
    if (const auto by = run.increment(axis)) {
      program[axis] += *by;
      named.add(axis);
    }
    const auto value = run.axis(axis);
    if (!value) continue;
    program[axis] = state.incremental ? program[axis] + *value : *value;
    named.add(axis);
  }
  if (polar) {
    if (!apply_polar(run, program[Axis::x], program[Axis::y])) return std::nullopt;
    named.add(Axis::x);
    named.add(Axis::y);
  }
  const PlaneAxes axes = axes_of(state.plane);
  if (state.polar.on && (named.has(axes.first) || named.has(axes.second))) {
    if (!place_polar(run, to_program(state, start), program)) return std::nullopt;
    named.add(axes.first);
    named.add(axes.second);
  }
  if (!first_move_in_frame(run, named, program)) return std::nullopt;
  AxisValues tip = to_tip(state, program);
  // What no word named stays exactly where it is.
  const AxisSet moved = moved_by(state, named);
  for (const Axis axis : all_axes)
    if (!moved.has(axis)) tip[axis] = start[axis];
  return tip;
}

}  // namespace

std::optional<AxisValues> target_of(BlockRun& run) {
  auto end = named_target(run);
  if (end && !apply_rotary_rules(run, *end)) return std::nullopt;
  return end;
}

bool feed_is_set(BlockRun& run, const CodeRule& rule) {
  if (run.state.feed_mode == canon::FeedMode::inverse_time) {
    if (run.feed_given && run.number_or('F', 0) > 0) return true;
    if (run.feed_given) {
      run.error("zero_feed", 'F', "in G93 F must be above 0: it is 1 / minutes of the move");
      return false;
    }
    run.error("feed_missing", rule,
              "in G93 every " + name_of(rule) + " line needs an F word of its own");
    return false;
  }
  if (run.state.feed_mode == canon::FeedMode::per_revolution && run.state.spindles[0].speed == 0) {
    run.error(
        "spindle_stopped", rule,
        name_of(rule) + " with feed per revolution (G95) needs a spindle speed; give S before");
    return false;
  }
  if (run.state.feed > 0) return true;
  run.error("zero_feed", rule, name_of(rule) + " with feed 0; give an F word above 0 first");
  return false;
}

double note_inverse_time(BlockRun& run, canon::Way way) {
  ModalState& state = run.state;
  if (state.feed_mode != canon::FeedMode::inverse_time || run.session.table.dialect().macro_b)
    return 0;
  constexpr double least = 0.1;  // per minute, of the control
  const double units = way.rotary ? way.length / radian_per_degree : way.length / state.unit_mm();
  state.feed = std::max(least, units * run.number_or('F', 0));
  return way.length * run.number_or('F', 0) / 60;
}

void rapid(const CodeRule&, BlockRun& run) {
  const auto end = target_of(run);
  if (!end) return;
  if (run.state.comp.side != CompSide::off || run.state.comp.leaving)
    return run.session.compensator.move(run, {PlannedMove::Kind::rapid, *end, {}});
  const bool clamped = turns_indexer(run);
  if (clamped) begin_exact_path(run);
  run.emit(canon::Rapid{*end});
  if (clamped) end_exact_path(run);
  run.state.tip = *end;
}

void linear_feed(const CodeRule& rule, BlockRun& run) {
  if (!feed_is_set(run, rule)) return;
  if (const auto angle = run.session.table.lathe() ? line_angle(run) : std::nullopt)
    return line_by_angle(rule, run, *angle);
  const auto end = target_of(run);
  if (!end) return;
  double rate = 0;
  if (run.state.feed_mode == canon::FeedMode::inverse_time)
    rate = note_inverse_time(run, canon::straight_way(run.state.programmed_tip(), *end));
  if (!is_free(run)) return make_move(run, rule, {PlannedMove::Kind::feed, *end, {}, rate});
  run.emit(canon::LinearFeed{*end});
  run.state.tip = *end;
}

void cancel_motion(const CodeRule&, BlockRun&) {}

namespace {

bool refuse_with_comp(BlockRun& run, const CodeRule& rule, bool even_without_radius = false) {
  const CompState& comp = run.state.comp;
  if (comp.side == CompSide::off || (comp.radius == 0 && !even_without_radius)) return false;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return true;
}

bool has_axes(BlockRun& run, const CodeRule& rule) {
  if (run.has_axis_words() || run.has('@') || run.has('^')) return true;
  run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  return false;
}

// With a K of 0 or less the control waits forever for a spindle position at which to move on.
bool has_pitch(BlockRun& run, const CodeRule& rule) {
  if (run.has('K') && *run.number('K') > 0) return true;
  if (run.has('K'))
    run.error("thread_error", 'K',
              "K of " + name_of(rule) +
                  ", the distance per revolution, must be above 0, or the move never ends");
  else
    run.error("word_missing", rule, name_of(rule) + " needs K: the distance per revolution");
  return false;
}

}  // namespace

void thread(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule) || !has_axes(run, rule) || !has_pitch(run, rule)) return;
  const auto spindle = spindle_of(run, 0);
  if (!spindle || !spindle_turns(run, rule, *spindle)) return;
  if (run.has('F'))
    return run.error("word_unused", 'F', "G33 takes its feed from K and the spindle; leave F out");
  const auto end = target_of(run);
  if (!end) return;
  canon::SyncFeed move;
  move.end = *end;
  move.per_revolution = run.length('K');
  move.spindle = *spindle;
  run.emit(std::move(move));
  run.state.tip = *end;
  if (run.state.comp.entered) run.state.comp.programmed = *end;
  run.state.comp.leaving = run.state.comp.entered;
}

// The position after rigid tapping is where it began, but for rotary axes.
void rigid_tap(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule) || !has_axes(run, rule) || !has_pitch(run, rule)) return;
  const auto spindle = spindle_of(run, 0);
  if (!spindle || !spindle_turns(run, rule, *spindle)) return;
  if (run.has('F'))
    return run.error("word_unused", 'F',
                     "G33.1 takes its feed from K and the spindle; leave F out");
  const double factor = run.number_or('I', 1);
  if (factor < 1)
    return run.error("word_value", 'I', "I, the speed factor of the way back, must be 1 or more");
  const auto end = target_of(run);
  if (!end) return;
  canon::SyncFeed move;
  move.end = *end;
  move.per_revolution = run.length('K');
  move.rigid_tap = true;
  move.return_factor = factor;
  move.spindle = *spindle;
  run.emit(std::move(move));
  for (const Axis axis : all_axes)  // only the linear axes come back, as the control sees it
    if (is_rotary(axis)) run.state.tip[axis] = (*end)[axis];
  run.state.comp.leaving = run.state.comp.entered;
}

void probe(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule, true) || !has_axes(run, rule)) return;
  if (run.state.feed_mode == canon::FeedMode::per_revolution)
    return run.error("probe_error", rule, "probing can't be done with G95; give G94 and F before");
  const bool inverse_time = run.state.feed_mode == canon::FeedMode::inverse_time;
  if (inverse_time && run.state.feed <= 0)
    return run.error("zero_feed", rule,
                     name_of(rule) +
                         " in G93 moves with the feed of the last move, and there was "
                         "none; give G94 and F before");
  if (!inverse_time && !feed_is_set(run, rule)) return;
  const auto end = target_of(run);
  if (!end) return;
  const bool must_hit = rule.code == 382 || rule.code == 384;
  double travel = 0;
  for (const Axis axis : all_axes)
    travel = std::max(travel, std::fabs((*end)[axis] - run.state.tip[axis]));
  if (must_hit && travel < 1e-9)
    return run.error("probe_error", rule,
                     "the end of the probing move is the current point; give another end point");
  canon::Probe move;
  move.end = *end;
  move.away = rule.code >= 384;
  move.error_if_missed = must_hit;
  if (const canon::Way way = canon::straight_way(run.state.tip, *end);
      inverse_time && way.length > 0) {
    const double unit = way.rotary ? radian_per_degree : run.state.unit_mm();
    canon::SetFeedRate rate;
    rate.value = run.state.feed * unit / 60 / way.length;
    run.emit(rate);
  }
  run.emit(move);
  run.state.tip = *end;
}

}  // namespace aircut::interp
