// Tool offsets of Fanuc-like controls: G43 G44 G49 with H, G41 G42 with D, and the T word of
// lathes.
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"

namespace aircut::interp {
namespace {

const ToolOffset* row_of(BlockRun& run, int number, Place place) {
  const ToolOffset* row = run.session.offsets.tool(number);
  if (!row)
    run.error("tool_unknown", place,
              "the tool offset " + std::to_string(number) +
                  " is neither in the tool table nor set by G10; add it");
  return row;
}

// Whether the line's moves are incremental: G90 and G91 on it act later than its G43.
bool line_is_incremental(const BlockRun& run) {
  for (const Word& word : run.block.words)
    if (word.rule && word.rule->group == ModalGroup::distance) return word.rule->code == 910;
  return run.state.incremental;
}

// On a Fanuc the words mean where the tip goes, so a new offset without a Z word moves the machine
// until the tip is where its coordinates say; with a Z word it is part of that move. On a Haas a
// new offset alone moves nothing.
void take_length_offset(BlockRun& run, const AxisValues& offset, int number) {
  ModalState& state = run.state;
  const AxisValues before = state.tip;
  state.length_suspended = false;
  if (offset == state.length_offset) return;
  use_length_offset(run, offset, number);
  if (run.session.options.dialect == Dialect::haas) return;
  if (run.has('Z') && run.motion_rule) {
    if (line_is_incremental(run)) state.tip[Axis::z] = before[Axis::z];
    return;
  }
  state.tip = before;
  if (state.motion == 10 && state.feed > 0)
    run.emit(canon::LinearFeed{before}, "tool length offset");
  else
    run.emit(canon::Rapid{before}, "tool length offset");
}

}  // namespace

// Tool centre point control takes its offset as G43 does, in the kinematics without it; then the
// machine goes over to the one with it. Any other code of the group ends it first.
void fanuc_length_offset(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  const KinematicsSwitch& models = run.session.options.kinematics;
  const bool tcp = rule.code == 434 || rule.code == 2340;
  if (tcp && (!models.tcp_on || !models.tcp_off))
    return run.error("unsupported_code", rule,
                     name_of(rule) +
                         " needs to know the machine's kinematics with and without tool centre "
                         "point control: name a machine that has [tcp] with -m");
  if (state.comp.side != CompSide::off)
    return run.error("comp_illegal", rule,
                     name_of(rule) +
                         " can't be used while radius compensation is on; give G40 "
                         "before");
  if (state.tcp) {
    state.tcp = false;
    if (state.kinematics != *models.tcp_off)
      return run.switch_kinematics({*models.tcp_off, false, false}, true);
  }
  if (rule.code == 490) return take_length_offset(run, {}, 0);
  const auto h = run.has('H') ? run.integer('H', 0, OffsetMemory::max_tool)
                              : std::optional<int>(state.length_number);
  if (!h) return;
  if (!run.has('H') && state.length_number < 0)
    return run.error("word_missing", rule, name_of(rule) + " needs H: the number of the offset");
  AxisValues offset;
  if (*h != 0) {
    const ToolOffset* row = row_of(run, *h, run.has('H') ? run.place('H') : run.place(rule));
    if (!row) return;
    offset[Axis::z] = (rule.code == 440 ? -1 : 1) * row->axes()[Axis::z];
  }
  state.length_number = *h;
  take_length_offset(run, offset, *h);
  if (!tcp) return;
  state.tcp = true;
  if (state.kinematics != *models.tcp_on) run.switch_kinematics({*models.tcp_on, false, false});
}

namespace {

// D is a row of offsets; one that is named after another tool, with another radius, is doubtful.
void judge_radius_row(BlockRun& run, int number, double radius) {
  const int tool = run.state.tool;
  const auto& offsets = run.session.offsets;
  if (!run.has('D') || tool == 0 || number == tool || run.session.table.lathe()) return;
  const ToolOffset* own = offsets.tool(tool);
  if (!own || !run.session.tools.find(number) || own->whole_radius() == radius) return;
  run.warning("wrong_offset", run.place('D'),
              "the offset D" + std::to_string(number) + " has the radius " + fixed(radius, 4) +
                  " mm, that of tool " + std::to_string(tool) + " in the spindle " +
                  fixed(own->whole_radius(), 4) +
                  " mm, and there is a tool of that number; give D" + std::to_string(tool) +
                  " if that is meant");
}

}  // namespace

void fanuc_radius_comp(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (state.comp.side != CompSide::off) {
    // The other side on the way is not implemented; the same code again changes nothing.
    const bool same = (rule.code == 410) == (state.comp.side == CompSide::left);
    if (same && !run.has('D')) return;
    return run.error("comp_illegal", rule,
                     name_of(rule) +
                         " while radius compensation is on can't be followed here; "
                         "give G40 before");
  }
  if (run.has('D')) {
    const auto d = run.integer('D', 0, OffsetMemory::max_tool);
    if (!d) return;
    state.offset_number = *d;
  }
  if (state.offset_number < 0)
    return run.error("word_missing", rule, name_of(rule) + " needs D: the number of the offset");
  double radius = 0;
  int orientation = 0;
  if (state.offset_number != 0) {
    const ToolOffset* row =
        row_of(run, state.offset_number, run.has('D') ? run.place('D') : run.place(rule));
    if (!row) return;
    radius = row->whole_radius();
    judge_radius_row(run, state.offset_number, radius);
    if (run.session.table.lathe()) orientation = row->orientation;
  }
  const CompSide side = rule.code == 410 ? CompSide::left : CompSide::right;
  start_compensation(rule, run, side, radius, orientation);
}

void fanuc_change_tool(const CodeRule& rule, BlockRun& run) {
  tell_frames_left_on(rule, run);
  change_tool(rule, run);
}

// T0103: tool 1 with offset 3; T0100 takes the offset away. There is no M6.
void lathe_tool_word(BlockRun& run) {
  const auto word = run.integer('T', 0, 99999);
  if (!word) return;
  ModalState& state = run.state;
  if (state.comp.side != CompSide::off)
    return run.error("comp_illegal", 'T',
                     "the tool can't be changed while radius compensation is on; give G40 before");
  const int tool = *word / 100, number = *word % 100;
  if (tool != 0 && !run.session.tools.find(tool))
    return run.error("tool_unknown", 'T',
                     "tool " + std::to_string(tool) +
                         " is not in the tool table; T0103 means tool 1 with offset 3");
  AxisValues offset;
  if (number != 0) {
    const ToolOffset* row = row_of(run, number, run.place('T'));
    if (!row) return;
    offset = row->axes();
  }
  if (tool != 0 && tool != state.tool) {
    state.selected_tool = state.tool = tool;
    run.emit(canon::SelectTool{tool});
    run.emit(canon::ChangeTool{tool});
  }
  state.offset_number = number;
  use_length_offset(run, offset, number);
}

}  // namespace aircut::interp
