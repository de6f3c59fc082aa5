// T selects, M6 changes, M61 renames. What M6 does on the way to a new tool is the machine's: its
// set-up may stop the spindle or not, lift the quill, and go to a place first, in this order.
//
// Random tool changers: the spindle is pocket 0, and M6 swaps the tool in it with the one in the
// selected tool's pocket, so pockets change and T0 is a tool as any other. Others keep their
// pockets, and T0 empties the spindle.
#include <algorithm>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

bool tool_is_known(BlockRun& run, int number, Place place) {
  const tool::ToolTable& tools = run.session.tools;
  if (tools.find(number) || (number == 0 && !tools.random_changer)) return true;
  run.error("tool_unknown", place,
            number == 0 ? "on a random tool changer T0 is a tool of its own, and it is not in the "
                          "tool table; add it or select another one"
                        : "tool " + std::to_string(number) +
                              " is not in the tool table; add it or select another one");
  return false;
}

void stop_spindles(BlockRun& run) {
  for (int i = 0; i < run.session.options.spindles; ++i) {
    run.state.spindles[static_cast<std::size_t>(i)].turn = canon::SpindleTurn::stop;
    canon::TurnSpindle stop;
    stop.spindle = i;
    run.emit(stop);
  }
}

// The control marks these moves for its screen, as part of the change and not of the program.
class HiddenMoves {
 public:
  explicit HiddenMoves(BlockRun& run) : run_(run) { mark("AXIS,hide"); }
  ~HiddenMoves() { mark("AXIS,show"); }
  HiddenMoves(const HiddenMoves&) = delete;
  HiddenMoves& operator=(const HiddenMoves&) = delete;

 private:
  void mark(const char* text) { run_.emit(canon::Message{canon::Message::Kind::comment, text}); }
  BlockRun& run_;
};

void go_to_change_position(BlockRun& run) {
  const Options& options = run.session.options;
  ModalState& state = run.state;
  if (options.tool_change_quill_up) {
    const HiddenMoves hidden(run);
    state.tip[Axis::z] = -state.length_offset[Axis::z];
    run.emit(canon::Rapid{state.tip}, "M6 quill up");
  }
  if (options.tool_change_at_g30) {
    const HiddenMoves hidden(run);
    go_to_stored(run, number::g30_position, {}, "M6 to G30 position");
  }
  if (const auto& position = options.tool_change_position) {
    for (const Axis axis : all_axes)
      if (position->first.has(axis))
        state.tip[axis] = position->second[axis] - state.length_offset[axis];
    run.emit(canon::Rapid{state.tip}, "M6 to tool change position");
  }
}

void swap_pockets(BlockRun& run, int in_spindle, int selected) {
  if (in_spindle == selected) return;
  tool::Tool* incoming = run.change_tool(selected);
  tool::Tool* outgoing = run.change_tool(in_spindle);
  if (outgoing) outgoing->pocket = incoming ? incoming->pocket : outgoing->pocket;
  if (incoming) incoming->pocket = 0;
}

}  // namespace

void tool_word(BlockRun& run) {
  const auto number = run.integer('T', 0, 99999);
  if (!number || !tool_is_known(run, *number, run.place('T'))) return;
  run.state.selected_tool = *number;
  run.emit_now(canon::SelectTool{*number});
}

void change_tool(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  const Options& options = run.session.options;
  if (state.comp.side != CompSide::off)
    return run.error("comp_illegal", rule,
                     "M6 can't be used while radius compensation is on; give G40 before");
  if (state.selected_tool < 0)
    run.warning("tool_not_selected", run.place(rule),
                "M6 before any T word empties the spindle; select a tool with T before");
  if (!options.tool_change_with_spindle) stop_spindles(run);
  go_to_change_position(run);
  if (!run.ok()) return;
  const int number = std::max(0, state.selected_tool);
  if (run.session.tools.random_changer) swap_pockets(run, state.tool, number);
  state.tool = number;
  run.emit(canon::ChangeTool{number});
  if (!options.retain_length_offset || !state.length_offset_on) return;
  const tool::Tool* tool = run.session.tools.find(number);
  use_length_offset(run, tool ? tool->offset : AxisValues{}, number);
  state.length_offset_on = number != 0;
}

void set_tool_number(const CodeRule& rule, BlockRun& run) {
  if (run.state.comp.side != CompSide::off)
    return run.error("comp_illegal", rule,
                     "M61 can't be used while radius compensation is on; give G40 before");
  if (!run.has('Q'))
    return run.error("word_missing", rule, "M61 needs Q: the number of the tool in the spindle");
  const auto number = run.integer('Q', 0, 99999);
  if (!number || !tool_is_known(run, *number, run.place('Q'))) return;
  run.state.tool = *number;
  run.emit(canon::SetToolNumber{*number});
}

}  // namespace aircut::interp
