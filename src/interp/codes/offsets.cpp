// Work systems, G10, G92 and G52, tool length offsets, G28 and G30, G53.
// Changing an offset moves no axis: the controlled point (tip + length offset) stays, only what it
// is called changes.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

bool refuse_with_comp(BlockRun& run, const CodeRule& rule) {
  if (run.state.comp.side == CompSide::off) return false;
  run.error("comp_illegal", rule,
            name_of(rule) + " can't be used while radius compensation is on; give G40 before");
  return true;
}

int system_base(int system) { return number::first_system + 20 * (system - 1); }

AxisSet axes_given(const BlockRun& run) {
  AxisSet axes;
  for (const Axis axis : all_axes)
    if (run.has(letter(axis))) axes.add(axis);
  return axes;
}

// When the rotation changes, the control turns the current point about the origin of the work
// system and forgets that G92 shifts that: it takes the point for another one from then on.
void lose_point_of_g92(BlockRun& run, const ModalState& before) {
  ModalState& state = run.state;
  const bool shifted = state.g92[Axis::x] != 0 || state.g92[Axis::y] != 0;
  if (state.rotation == before.rotation || !shifted) return;
  const AxisValues reads = to_program(before, before.tip);
  ModalState old = before, now = state;
  old.g92 = now.g92 = {};
  const AxisValues believed = to_tip(state, to_program(now, to_tip(old, reads)));
  state.tip[Axis::x] = believed[Axis::x];
  state.tip[Axis::y] = believed[Axis::y];
  run.warning("control_fault", run.place('R'),
              "the control misplaces the current point when the rotation changes while G92 or G52 "
              "is in force; give G92.1 before, or both X and Y on the next move");
}

void reload_if_active(BlockRun& run, int system) {
  ModalState& state = run.state;
  if (system != state.system) return;
  const ModalState before = state;
  load_work_system(run, system);
  lose_point_of_g92(run, before);
  run.emit_work_offset();
  run.emit_rotation();
}

// G10 L2 and L20: the offsets of a work system, as numbers or such that the current point reads the
// words.
void set_work_system(const CodeRule& rule, BlockRun& run, bool from_position) {
  if (!run.has('P'))
    return run.error("g10_error", rule,
                     "G10 L2 and L20 need P: the system 1-9, or 0 for the active one");
  const auto p = run.integer('P', 0, 9, "g10_error");
  if (!p) return;
  const int system = *p == 0 ? run.state.system : *p;
  if (run.state.comp.side != CompSide::off && system == run.state.system)
    return run.error("comp_illegal", rule,
                     "the active work system can't be changed while radius compensation is on");
  for (const char word : {'I', 'J'})
    if (run.has(word))
      return run.error("g10_error", word,
                       "I and J belong to tool data (G10 L1), not to work systems");
  if (from_position && run.has('R'))
    return run.error("g10_error", 'R', "G10 L20 takes no R; set the rotation with G10 L2");

  const int base = system_base(system);
  if (run.has('R')) run.set_parameter(base + 9, *run.number('R'));
  AxisValues offset = run.stored_axes(base);
  if (!from_position) {
    for (const Axis axis : all_axes)
      if (const auto value = run.axis(axis)) offset[axis] = *value;
  } else {
    // offset = tip − R(rotation) · (wanted + g92): with rotation, X and Y depend on each other, so
    // a coordinate that is not named keeps its present reading in the target system.
    ModalState there = run.state;
    there.work_offset = offset;
    there.rotation = run.parameter(base + 9) * radian_per_degree;
    AxisValues wanted = to_program(there, run.state.tip);
    for (const Axis axis : all_axes)
      if (const auto value = run.axis(axis)) wanted[axis] = *value;
    there.work_offset = {};
    const AxisValues without_offset = to_tip(there, wanted);
    for (const Axis axis : all_axes) {
      const bool turned = (axis == Axis::x || axis == Axis::y) && there.rotation != 0 &&
                          (run.has('X') || run.has('Y'));
      if (run.has(letter(axis)) || turned)
        offset[axis] = run.state.tip[axis] - without_offset[axis];
    }
  }
  run.store_axes(base, offset);
  reload_if_active(run, system);
}

bool set_lathe_data(BlockRun& run, tool::Tool& tool) {
  if (run.has('R')) tool.diameter = 2 * run.length('R');
  if (run.has('I')) tool.front_angle = *run.number('I') * radian_per_degree;
  if (run.has('J')) tool.back_angle = *run.number('J') * radian_per_degree;
  if (!run.has('Q')) return true;
  const auto orientation = run.integer('Q', 0, 9, "g10_error");
  if (!orientation) return false;
  tool.orientation = *orientation;
  return true;
}

// G10 L1: tool data as numbers. L10: such that the current point reads the words once the offset is
// loaded. L11: the same in system 9 (G59.3) without G92.
void set_tool_data(const CodeRule& rule, BlockRun& run, int kind) {
  if (!run.has('P'))
    return run.error("g10_error", rule, "G10 L1, L10 and L11 need P: the number of the tool");
  const auto number = run.integer('P', 1, 99999, "g10_error");
  if (!number) return;
  const AxisSet axes = axes_given(run);
  if (axes.empty() && !run.has('R') && !run.has('I') && !run.has('J') && !run.has('Q'))
    return run.error("g10_error", rule,
                     "G10 for a tool needs at least one of the axis words, R, I, J or Q");
  tool::Tool* tool = run.change_tool(*number);
  if (!tool)
    return run.error("tool_unknown", 'P',
                     "tool " + std::to_string(*number) + " is not in the tool table");
  ModalState frame = run.state;
  if (kind != 1) {  // from the parameters, which a program may have changed since
    const int base = system_base(kind == 11 ? 9 : run.state.system);
    const bool shifted = kind == 10 && run.parameter(number::g92_applied) != 0;
    frame.g92 = shifted ? run.stored_axes(number::g92_offset) : AxisValues{};
    frame.work_offset = run.stored_axes(base);
    frame.rotation = run.parameter(base + 9) * radian_per_degree;
  }
  // The controlled point must read the words with the new offset: tip = point − offset.
  const AxisValues point = run.state.tip + run.state.length_offset;
  // Axes without a word keep what they would read with the old one.
  AxisValues wanted = to_program(frame, point - tool->offset);
  for (const Axis axis : all_axes)
    if (const auto value = run.axis(axis)) wanted[axis] = *value;
  const AxisValues tip = to_tip(frame, wanted);
  for (const Axis axis : all_axes) {
    const auto value = run.axis(axis);
    const bool turned = kind != 1 && frame.rotation != 0 && axis <= Axis::y &&
                        (axes.has(Axis::x) || axes.has(Axis::y));
    if (value || turned) tool->offset[axis] = kind == 1 ? *value : point[axis] - tip[axis];
  }
  set_lathe_data(run, *tool);
}

}  // namespace

void load_work_system(BlockRun& run, int system) {
  if (run.session.table.dialect().macro_b) {
    const OffsetMemory& offsets = run.session.offsets;
    run.state.system = system;
    run.state.work_offset = offsets.system(OffsetMemory::common) + offsets.system(system);
    return;
  }
  const int base = system_base(system);
  run.state.system = system;
  run.state.work_offset = run.stored_axes(base);
  run.state.rotation = run.parameter(base + 9) * radian_per_degree;
}

void set_data(const CodeRule& rule, BlockRun& run) {
  if (!run.has('L')) return run.error("g10_error", rule, "G10 needs L: 1, 2, 10, 11 or 20");
  const auto l = run.integer('L', 0, 20, "g10_error");
  if (!l) return;
  switch (*l) {
    case 0:  // reload: the table is in memory already
      if (run.state.tool != 0)
        run.error("g10_error", rule,
                  "G10 L0 reloads the tool table, which needs an empty spindle; give T0 M6 before");
      return;
    case 1:
    case 10:
    case 11:
      return set_tool_data(rule, run, *l);
    case 2:
      return set_work_system(rule, run, false);
    case 20:
      return set_work_system(rule, run, true);
    default:
      return run.error("g10_error", 'L',
                       "G10 knows L0, L1, L2, L10, L11 and L20, not L" + std::to_string(*l));
  }
}

void machine_coordinates(const CodeRule& rule, BlockRun& run) {
  if (run.state.incremental)
    return run.error("g53_error", rule, "G53 needs absolute distances; give G90 before");
  if (run.state.comp.side != CompSide::off && run.state.comp.radius > 0)
    return run.error("g53_error", rule,
                     "G53 can't be used while radius compensation is on; give G40 before");
  if (!run.motion_rule || (run.motion_rule->code != 0 && run.motion_rule->code != 10))
    return run.error("g53_error", rule, "G53 works with G0 and G1 only; give one of them");
  run.machine_coordinates = true;
}

void go_to_stored(BlockRun& run, int first_number, AxisSet axes, const std::string& what) {
  const ModalState& state = run.state;
  AxisValues home = run.stored_axes(first_number);
  for (const Axis axis : all_axes)  // the control leaves the length offset of rotary axes out
    if (!is_rotary(axis)) home[axis] -= state.length_offset[axis];
  // Named axes go to the stored point's program coordinates; with a rotation X and Y mix.
  AxisValues mixed = to_program(state, state.tip);
  const AxisValues there = to_program(state, home);
  for (const Axis axis : all_axes)
    if (axes.has(axis)) mixed[axis] = there[axis];
  const AxisValues turned = to_tip(state, mixed);
  const bool in_plane = state.rotation != 0 && (axes.has(Axis::x) || axes.has(Axis::y));
  AxisValues end = state.tip;
  AxisSet moved;
  for (const Axis axis : all_axes) {
    if (in_plane && axis <= Axis::y) {
      end[axis] = turned[axis];
    } else if (axes.empty() || axes.has(axis)) {
      end[axis] = home[axis];
      moved.add(axis);
    }
  }
  if (wrap_stored(run, end, moved)) rapid_with_indexers(run, end, what);
}

void go_home(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  const AxisSet axes = axes_given(run);
  const auto middle = target_of(run);
  if (!middle) return;
  const std::string what = name_of(rule);
  rapid_with_indexers(run, *middle, what + " intermediate point");
  go_to_stored(run, rule.code == 280 ? number::g28_position : number::g30_position, axes,
               what + " stored position");
}

void store_home(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  run.store_axes(rule.code == 281 ? number::g28_position : number::g30_position,
                 run.state.tip + run.state.length_offset);
}

void use_length_offset(BlockRun& run, const AxisValues& offset, int tool) {
  run.state.tip += run.state.length_offset - offset;
  run.state.length_offset = offset;
  run.emit(canon::ToolLengthOffset{offset, tool});
}

namespace {

// With RETAIN_G43 the control takes the offset of the tool in the spindle again before the next
// line, whatever a code has set.
void retain_length_offset(const CodeRule& rule, BlockRun& run) {
  if (!run.session.options.retain_length_offset) return;
  const tool::Tool* loaded = run.session.tools.find(run.state.tool);
  const AxisValues kept = loaded ? loaded->offset : AxisValues{};
  run.state.length_offset_on = loaded != nullptr;
  if (run.state.length_offset == kept) return;
  run.warning("retained_offset", run.place(rule),
              "this machine keeps the length offset of the tool in the spindle (RETAIN_G43); " +
                  name_of(rule) + " has no lasting effect");
  use_length_offset(run, kept, run.state.tool);
}

void end_length_offset(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  const bool kept = run.session.options.retain_length_offset && state.length_offset_on &&
                    run.session.tools.find(state.tool) != nullptr;
  if (kept)
    return run.warning("retained_offset", run.place(rule),
                       "this machine keeps the length offset of the tool in the spindle "
                       "(RETAIN_G43), so G49 has no effect; T0 M6 ends it");
  state.length_offset_on = false;
  use_length_offset(run, {});
}

}  // namespace

void length_offset(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  if (rule.code == 490) return end_length_offset(rule, run);
  if (rule.code == 432 && run.has('H') && !axes_given(run).empty())
    return run.error("axis_conflict", rule, "G43.2 takes H or axis words, not both");
  run.state.length_offset_on = true;
  AxisValues offset = run.state.length_offset;
  const bool by_axes = rule.code == 431 || (rule.code == 432 && !run.has('H'));
  if (by_axes) {
    const bool none = axes_given(run).empty();
    if (none && rule.code == 431)
      run.warning("word_ignored", run.place(rule),
                  "G43.1 without axis words changes nothing; give the axes of the offset");
    else if (none)
      return run.error("axis_word_missing", rule, "G43.2 needs H or axis words");
    for (const Axis axis : all_axes)
      if (const auto value = run.axis(axis))
        offset[axis] = rule.code == 431 ? *value : offset[axis] + *value;
    if (run.motion_rule)
      run.warning("shared_axis_words", run.place(rule),
                  "the axis words of this line set the length offset and are the end of the move "
                  "too; put " +
                      name_of(rule) + " on a line of its own");
    use_length_offset(run, offset);
    return retain_length_offset(rule, run);
  }
  int number = run.state.tool;
  if (run.has('H')) {
    const auto h = run.integer('H', 0, 99999);
    if (!h) return;
    if (*h != 0) number = *h;
  }
  const tool::Tool* tool = run.session.tools.find(number);
  if (!tool && number != 0)
    return run.error("tool_unknown", run.has('H') ? run.place('H') : run.place(rule),
                     "tool " + std::to_string(number) + " is not in the tool table");
  const AxisValues of_tool = tool ? tool->offset : AxisValues{};
  if (rule.code == 432)
    use_length_offset(run, offset + of_tool);
  else
    use_length_offset(run, of_tool, number);
  retain_length_offset(rule, run);
}

void work_system(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  const int system = rule.code <= 590 ? (rule.code - 530) / 10 : rule.code - 590 + 6;
  if (system == run.state.system) return;
  run.set_parameter(number::active_system, system);
  load_work_system(run, system);
  run.emit_work_offset();
  run.emit_g92();
  run.emit_rotation();
}

// G52 sets the registers of G92 to the words.
void local_offset(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  if (!run.has_axis_words())
    return run.error("axis_word_missing", rule, "G52 needs at least one axis word");
  for (const Axis axis : all_axes)
    if (const auto value = run.axis(axis)) run.state.g92[axis] = *value;
  run.store_axes(number::g92_offset, run.state.g92);
  run.set_parameter(number::g92_applied, 1);
  run.emit_g92();
}

void g92(const CodeRule& rule, BlockRun& run) {
  if (refuse_with_comp(run, rule)) return;
  ModalState& state = run.state;
  if (rule.code == 920) {
    if (!run.has_axis_words())
      return run.error("axis_word_missing", rule, "G92 needs at least one axis word");
    // The point reads `program` now and the word afterwards.
    const AxisValues program = to_program(state, state.tip);
    for (const Axis axis : all_axes)
      if (const auto value = run.axis(axis)) state.g92[axis] += program[axis] - *value;
    run.store_axes(number::g92_offset, state.g92);
    run.set_parameter(number::g92_applied, 1);
  } else if (rule.code == 923) {
    state.g92 = run.stored_axes(number::g92_offset);
    run.set_parameter(number::g92_applied, 1);
  } else {
    state.g92 = {};
    if (rule.code == 921) run.store_axes(number::g92_offset, {});
    run.set_parameter(number::g92_applied, 0);
  }
  run.emit_g92();
}

}  // namespace aircut::interp
