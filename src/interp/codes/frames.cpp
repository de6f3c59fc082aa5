// Fanuc's frames of the program: G51.1 and G50.1 (mirror image), G51 and G50 (scaling), G68 and G69
// (rotation). program_frame.cpp has the map; here are the words, and what the controls forbid.
//
// Mirror, scaling and rotation are given in this order and taken back in the reverse one, and none
// of them while radius compensation is on. While one is on, the plane, the work system and the
// reference points are out of reach: the manuals forbid them.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

bool comp_is_off(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side == CompSide::off && !run.state.comp.leaving) return true;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return false;
}

void frame_changed(BlockRun& run) {
  ProgramFrame& frame = run.state.frame;
  frame.update();
  run.emit(canon::ProgramMap{frame.linear(), frame.shift()});
}

Vec3 xyz(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

bool linear_words_only(BlockRun& run, const CodeRule& rule) {
  for (const Axis axis : all_axes) {
    if (axis <= Axis::z || !run.has(letter(axis))) continue;
    run.error("unsupported_code", letter(axis),
              name_of(rule) + " of the axis " + letter(axis) +
                  " is not implemented here; this line can't be checked");
    return false;
  }
  return true;
}

// The factors of P, or of I J K; nothing with an error.
std::optional<Vec3> factors_of(BlockRun& run, const CodeRule& rule) {
  const Word* common = run.block.find('P');
  const char letters[] = {'I', 'J', 'K'};
  Vec3 factors = Vec3::Ones();
  for (int i = 0; i < 3; ++i) {
    const Word* own = run.block.find(letters[i]);
    if (own && common) {
      run.error("frame_error", own->place, "G51 takes P for all axes, or I J K; not both");
      return std::nullopt;
    }
    const Word* word = common ? common : own;
    if (!word) {
      run.error("word_missing", rule,
                std::string("without ") + letters[i] +
                    " or P the factor of G51 comes from a parameter of the control; give P for "
                    "all axes, or all of I J K");
      return std::nullopt;
    }
    factors[i] = thousandths(run, *word);
    if (factors[i] == 0 || !std::isfinite(factors[i])) {
      run.error("frame_error", word->place, "the factor of G51 can't be 0");
      return std::nullopt;
    }
  }
  return factors;
}

}  // namespace

// Digits of length words have been read as least increments already, 0.001 mm or 0.0001 inch;
// expressions have been rounded as lengths or whole numbers.
double thousandths(const BlockRun& run, const Word& word) {
  if (!word.text.constant()) {
    std::optional<Fault> fault;
    return evaluate(word.text, run.block.code, run.session.parameters, fault).value_or(word.number);
  }
  if (!word.no_point) return word.number;
  if (!(letter_bit(word.letter) & increment_letters)) return word.number / 1000;
  const bool inch = run.state.unit == canon::Unit::inch && !run.session.options.whole_units;
  return inch ? word.number * 10 : word.number;
}

void scaling(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  ProgramFrame& frame = state.frame;
  if (rule.code == 500 && !frame.scaled) return;
  if (!comp_is_off(run, rule)) return;
  if (frame.turned)
    return run.error("frame_error", rule,
                     name_of(rule) +
                         " can't be used while G68 is on; give G69 before: what comes "
                         "last goes first");
  if (rule.code == 500) {
    frame.scaled = false;
    frame.factors = Vec3::Ones();
    return frame_changed(run);
  }
  if (!linear_words_only(run, rule)) return;
  const auto factors = factors_of(run, rule);
  if (!factors) return;
  // A centre that is not named is where the tool is.
  Vec3 centre = frame.behind_scaling(xyz(to_program(state, state.tip)));
  AxisValues words;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) words[axis] = run.axis(axis).value_or(0);
  const Vec3 named = frame.behind_mirror(xyz(words));
  for (const Axis axis : {Axis::x, Axis::y, Axis::z})
    if (run.has(letter(axis)))
      centre[static_cast<int>(index(axis))] = named[static_cast<int>(index(axis))];
  frame.scaled = true;
  frame.factors = *factors;
  frame.scale_at = centre;
  frame_changed(run);
}

void mirror_image(const CodeRule& rule, BlockRun& run) {
  ProgramFrame& frame = run.state.frame;
  const bool on = rule.code == 511 || rule.code == 1010;
  const bool about_zero = rule.code == 1010;  // Haas G101 mirrors about work zero
  if (!on && !frame.any_mirror()) return;
  if (!comp_is_off(run, rule)) return;
  if (frame.scaled || frame.turned)
    return run.error("frame_error", rule,
                     name_of(rule) +
                         " can't be used while G51 or G68 is on; give G69 and G50 "
                         "before: what comes last goes first");
  if (!linear_words_only(run, rule)) return;
  if (on && !run.has_axis_words())
    return run.error("axis_word_missing", rule, name_of(rule) + " needs at least one axis word");
  if (on && !about_zero && run.state.incremental)
    return run.error("frame_error", rule,
                     "G51.1 in G91 means different places on different controls; give G90");
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    if (run.has_axis_words() && !run.has(letter(axis))) continue;
    const std::size_t i = index(axis);
    frame.mirrored[i] = on;
    frame.mirror_at[static_cast<int>(i)] = on && !about_zero ? *run.axis(axis) : 0;
  }
  frame_changed(run);
}

void rotation_on(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  ProgramFrame& frame = state.frame;
  if (!comp_is_off(run, rule)) return;
  for (const char word : {'I', 'J', 'K'})
    if (run.has(word))
      return run.error("unsupported_code", word,
                       "G68 with I J K (3-D coordinate conversion) is not implemented here; this "
                       "line can't be checked");
  const PlaneAxes axes = axes_of(state.plane);
  for (const Axis axis : all_axes)
    if (run.has(letter(axis)) && axis != axes.first && axis != axes.second)
      return run.error("frame_error", letter(axis),
                       std::string("the centre of G68 lies in the plane in force (") +
                           letter(axes.first) + " " + letter(axes.second) + "); leave " +
                           letter(axis) + " out or select another plane");
  const Word* angle = run.block.find('R');
  if (!angle)
    return run.error("word_missing", rule,
                     "without R the angle of G68 comes from a parameter of the control; give R");
  const AxisValues program = to_program(state, state.tip);
  // The centre: what is named is a program coordinate, what is not is where the tool stands.
  Vec3 centre = xyz(to_work(state, state.tip));
  AxisValues words = program;
  for (const Axis axis : {axes.first, axes.second})
    if (const auto value = run.axis(axis)) words[axis] = *value;
  const Vec3 named = frame.behind_scaling(xyz(words));
  for (const Axis axis : {axes.first, axes.second})
    if (run.has(letter(axis)))
      centre[static_cast<int>(index(axis))] = named[static_cast<int>(index(axis))];
  const double turn = thousandths(run, *angle) * radian_per_degree;
  const bool adds = frame.turned && state.incremental;
  if (adds)
    run.warning("control_setting", angle->place,
                "with G91 R adds to the angle in force, unless a setting of the control (Fanuc: "
                "parameter 5400 bit 0, Haas: setting 73) says otherwise; give G69 before");
  frame.angle = turn + (adds ? frame.angle : 0);
  frame.turned = true;
  frame.plane = state.plane;
  frame.turn_at = centre;
  state.before_turn = program;
  state.turn_is_fresh = true;
  state.turn_was_left = false;
  frame_changed(run);
}

void rotation_off(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (!state.frame.turned) return;
  if (!comp_is_off(run, rule)) return;
  state.turn_was_left = state.frame.angle != 0;
  state.turn_is_fresh = false;
  state.frame.turned = false;
  state.frame.angle = 0;
  frame_changed(run);
}

void reset_frames(BlockRun& run) {
  ModalState& state = run.state;
  state.polar = PolarState{};
  if (state.frame.active()) {
    state.frame = ProgramFrame{};
    frame_changed(run);
  }
  state.turn_is_fresh = state.turn_was_left = false;
}

void tell_frames_left_on(const CodeRule& rule, BlockRun& run) {
  const ProgramFrame& frame = run.state.frame;
  std::string on;
  const auto add = [&](bool is_on, const char* what) {
    if (is_on) on += std::string(on.empty() ? "" : ", ") + what;
  };
  add(frame.any_mirror(), "mirror image (G51.1)");
  add(frame.scaled, "scaling (G51)");
  add(frame.turned, "rotation (G68)");
  add(run.state.polar.on, "polar coordinates (G16)");
  if (on.empty()) return;
  run.warning("frame_left_on", run.place(rule),
              on + " still on at this " + name_of(rule) +
                  ": whether it is taken back depends on the control; take it back before");
}

// Behind G68 the control takes a coordinate of the plane that the first absolute move does not name
// from before G68; behind G69 it can't make an incremental one.
bool first_move_in_frame(BlockRun& run, AxisSet named, AxisValues& program) {
  ModalState& state = run.state;
  if (!state.turn_is_fresh && !state.turn_was_left) return true;
  const PlaneAxes axes = axes_of(state.frame.plane);
  const bool first = named.has(axes.first), second = named.has(axes.second);
  if (!first && !second) return true;
  if (state.turn_was_left && state.incremental) {
    for (const Axis axis : {axes.first, axes.second}) {
      if (!named.has(axis) || run.axis(axis).value_or(0) == 0) continue;
      run.error("frame_error", letter(axis),
                "behind G69 the first move in the plane must be absolute: with G91 the control "
                "does not know where it starts; give G90");
      return false;
    }
    return true;
  }
  if (state.turn_is_fresh && !state.incremental && first != second) {
    const Axis other = first ? axes.second : axes.first;
    program[other] = state.before_turn[other];
    run.warning("control_setting", run.place(letter(first ? axes.first : axes.second)),
                std::string("the first move behind G68 names only one axis of the plane: ") +
                    letter(other) +
                    " is taken from before G68, unless a parameter of the control "
                    "says otherwise; name both");
  }
  state.turn_is_fresh = state.turn_was_left = false;
  return true;
}

// The control does not scale pecks and shifts (Q), and G68 leaves open where the first hole is
// when only one of its coordinates is named.
bool frame_allows_cycle(BlockRun& run, const CodeRule& rule) {
  ModalState& state = run.state;
  const PlaneAxes axes = axes_of(state.plane);
  const auto unscaled = [&](Axis axis) {
    return std::fabs(state.frame.factors[static_cast<int>(index(axis))]) == 1;
  };
  const bool all = unscaled(axes.first) && unscaled(axes.second) && unscaled(axes.normal);
  if (run.has('Q') && !all) {
    run.error("frame_error", rule,
              name_of(rule) + " with Q while G51 scales is not implemented here; give G50 before");
    return false;
  }
  if (!state.turn_is_fresh && !state.turn_was_left) return true;
  const bool first = run.axis(axes.first).has_value(), second = run.axis(axes.second).has_value();
  if (first != second || (state.turn_was_left && state.incremental && first)) {
    run.error("frame_error", rule,
              "the first hole behind G68 or G69 needs both coordinates, with G90: what the control "
              "takes for a missing one depends on a parameter");
    return false;
  }
  if (first) state.turn_is_fresh = state.turn_was_left = false;
  return true;
}

bool frame_allows(BlockRun& run, const CodeRule& rule, AxisSet axes) {
  const ModalState& state = run.state;
  if (state.tcp) {
    run.error(
        "frame_error", rule,
        name_of(rule) + " can't be used while tool centre point control is on; give G49 before");
    return false;
  }
  if (!state.frame.active()) return true;
  bool touched = false;
  for (int i = 0; i < 3; ++i)
    if (axes.has(all_axes[static_cast<std::size_t>(i)]))
      touched = touched || state.frame.linear().row(i) != Mat3::Identity().row(i) ||
                state.frame.shift()[i] != 0;
  if (!touched) return true;
  run.error("frame_error", rule,
            name_of(rule) +
                " can't be used while mirror image, scaling or rotation acts on its "
                "axes; give G69, G50 or G50.1 before");
  return false;
}

}  // namespace aircut::interp
