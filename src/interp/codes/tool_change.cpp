// T selects, M6 changes, M61 renames.
#include <algorithm>

#include "interp/codes/codes.h"

namespace aircut::interp {

void tool_word(BlockRun& run) {
  const auto number = run.integer('T', 0, 99999);
  if (!number) return;
  if (*number != 0 && !run.session.tools.find(*number))
    return run.error("tool_unknown", 'T',
                     "tool " + std::to_string(*number) +
                         " is not in the tool table; add it or select another one");
  run.state.selected_tool = *number;
  run.emit_now(canon::SelectTool{*number});
}

void change_tool(const CodeRule& rule, BlockRun& run) {
  ModalState& state = run.state;
  if (state.comp.side != CompSide::off)
    return run.error("comp_illegal", rule,
                     "M6 can't be used while radius compensation is on; give G40 before");
  if (state.selected_tool < 0)
    run.warning("tool_not_selected", run.place(rule),
                "M6 before any T word empties the spindle; select a tool with T before");
  for (int i = 0; i < run.session.options.spindles; ++i) {
    state.spindles[static_cast<std::size_t>(i)].turn = canon::SpindleTurn::stop;
    canon::TurnSpindle stop;
    stop.spindle = i;
    run.emit(stop);
  }
  state.tool = std::max(0, state.selected_tool);
  run.emit(canon::ChangeTool{state.tool});
}

void set_tool_number(const CodeRule& rule, BlockRun& run) {
  if (run.state.comp.side != CompSide::off)
    return run.error("comp_illegal", rule,
                     "M61 can't be used while radius compensation is on; give G40 before");
  if (!run.has('Q'))
    return run.error("word_missing", rule, "M61 needs Q: the number of the tool in the spindle");
  const auto number = run.integer('Q', 0, 99999);
  if (!number) return;
  if (*number != 0 && !run.session.tools.find(*number))
    return run.error("tool_unknown", 'Q',
                     "tool " + std::to_string(*number) + " is not in the tool table");
  run.state.tool = *number;
  run.emit(canon::SetToolNumber{*number});
}

}  // namespace aircut::interp
