// Rotary axes of which the machine's set-up says something.
//
// Wrapped: in G90 a word names an angle from -359.999… to 359.999…, and its sign the way: the axis
// goes up to the next such angle (A90), or down to it. Where it is already it stays.
//
//   current 410:   A10 → 730      A-10 → 370      A50 → 410
//
// The turn is chosen in program coordinates. For a machine position (G53, G28, G30) the control
// takes the offsets off first and then drops the sign of what is left, so with an offset in force
// the axis stops at another angle than the one that was named. We follow it and say so.
//
// Clamped (locking indexers): such an axis moves alone, with G0, between its unlocking and locking.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

double degrees(double radians) {
  // Positions that were whole degrees are so again: the number of turns hangs on it.
  const double value = radians / radian_per_degree;
  return std::round(value * 1e9) / 1e9;
}

/// The angle of `size` (0 ≤ size) next to `current` on the way that the sign says, degrees.
double next_angle(double size, bool down, double current) {
  const double angle = size + 360 * std::floor(current / 360);
  if (!down && angle < current) return angle + 360;
  if (down && angle > current) return angle - 360;
  return angle;
}

bool in_one_turn(BlockRun& run, Axis axis, double word) {
  if (std::fabs(word) < 360) return true;
  run.error("wrapped_axis", letter(axis),
            std::string(1, letter(axis)) +
                " is a wrapped axis: in G90 its positions go from -360 "
                "to 360 degrees, both excluded; this is " +
                shortest(word));
  return false;
}

double offset_of(const ModalState& state, Axis axis) {
  return state.g92[axis] + state.work_offset[axis];
}

// Sets end[axis] to the wrapped angle; says so when that is not the machine angle that was asked.
void wrap_machine_position(BlockRun& run, AxisValues& end, Axis axis, double machine,
                           double current) {
  const ModalState& state = run.state;
  const double program = (end[axis] - offset_of(state, axis)) / radian_per_degree;
  const double angle = next_angle(std::fabs(program), std::signbit(machine), current);
  end[axis] = angle * radian_per_degree + offset_of(state, axis);
  const double got = degrees(end[axis] + state.length_offset[axis]);
  const double error = std::remainder(got - std::fabs(machine), 360);
  if (std::fabs(error) > 1e-6)
    run.warning("wrapped_offset", run.place(letter(axis)),
                std::string("the offsets in force lead the wrapped axis ") + letter(axis) +
                    " to machine position " + shortest(std::round(got * 1e6) / 1e6) + ", not to " +
                    shortest(machine) + ", as the control does it; turn this axis without offsets");
}

bool only_axis(const BlockRun& run, Axis axis) {
  const char own = letter(axis);
  return std::none_of(run.block.words.begin(), run.block.words.end(), [&](const Word& word) {
    constexpr std::uint32_t positions = axis_letters | letter_bit('@') | letter_bit('^');
    return word.letter != own && (letter_bit(word.letter) & positions) != 0;
  });
}

bool indexers_allow(BlockRun& run) {
  for (const Axis axis : {Axis::a, Axis::b, Axis::c}) {
    if (!run.session.options.indexers.has(axis) || !run.has(letter(axis))) continue;
    const std::string name(1, letter(axis));
    if (run.motion_rule->code != 0) {
      run.error("indexer_move", letter(axis),
                name + " is a clamped (indexing) axis: it can be moved with G0 only");
      return false;
    }
    if (!only_axis(run, axis)) {
      run.error("indexer_move", letter(axis),
                name +
                    " is a clamped (indexing) axis: it can be moved alone only; give the other "
                    "axes on a line of their own");
      return false;
    }
  }
  return true;
}

}  // namespace

bool apply_rotary_rules(BlockRun& run, AxisValues& end) {
  const Options& options = run.session.options;
  if (options.wrapped.empty() && options.indexers.empty()) return true;
  if (run.motion_rule && !indexers_allow(run)) return false;
  const ModalState& state = run.state;
  if (state.incremental) return true;
  for (const Axis axis : {Axis::a, Axis::b, Axis::c}) {
    const auto word = run.number(letter(axis));
    if (!word || !options.wrapped.has(axis)) continue;
    if (!in_one_turn(run, axis, *word)) return false;
    const double current = degrees(state.programmed_tip()[axis] - offset_of(state, axis));
    if (run.machine_coordinates) {
      wrap_machine_position(run, end, axis, *word, current);
    } else {
      const double angle = next_angle(std::fabs(*word), std::signbit(*word), current);
      end[axis] = angle * radian_per_degree + offset_of(state, axis);
    }
  }
  return true;
}

bool wrap_stored(BlockRun& run, AxisValues& end, AxisSet axes) {
  const ModalState& state = run.state;
  for (const Axis axis : {Axis::a, Axis::b, Axis::c}) {
    if (!run.session.options.wrapped.has(axis) || !axes.has(axis)) continue;
    const double machine = degrees(end[axis]);
    if (!in_one_turn(run, axis, machine)) return false;
    wrap_machine_position(run, end, axis, machine,
                          degrees(state.tip[axis] - offset_of(state, axis)));
  }
  return true;
}

void begin_exact_path(BlockRun& run) {
  if (run.state.path_mode != canon::PathMode::exact_path)
    run.emit(canon::SetPathMode{canon::PathMode::exact_path, 0});
}

void end_exact_path(BlockRun& run) {
  if (run.state.path_mode == canon::PathMode::exact_path) return;
  emit_path_mode(run);
  emit_naive_tolerance(run);
}

bool turns_indexer(const BlockRun& run) {
  const AxisSet indexers = run.session.options.indexers;
  return !indexers.empty() && std::any_of(all_axes.begin(), all_axes.end(), [&](Axis axis) {
    return indexers.has(axis) && run.has(letter(axis));
  });
}

void rapid_with_indexers(BlockRun& run, const AxisValues& end, const std::string& what) {
  ModalState& state = run.state;
  for (const Axis axis : {Axis::a, Axis::b, Axis::c}) {
    if (!run.session.options.indexers.has(axis) || end[axis] == state.tip[axis]) continue;
    state.tip[axis] = end[axis];
    begin_exact_path(run);
    run.emit(canon::Rapid{state.tip}, what);
    end_exact_path(run);
  }
  run.emit(canon::Rapid{end}, what);
  state.tip = end;
}

}  // namespace aircut::interp
