#include <algorithm>
#include <array>

#include "semantics/semantics.h"

namespace aircut::semantics {

namespace {

// Kinds of the interpreter that it gives as warnings: the control accepts the block.
constexpr std::array interpreter_warnings = {
    "comp_exit_short",    "comp_rapid",       "frame_left_on",
    "cycle_modal_change", "feed_before_unit", "shared_axis_words",
    "tool_not_selected",  "word_ignored",     "wrong_offset"};

}  // namespace

const std::vector<KindText>& semantic_kinds() {
  static const std::vector<KindText> kinds = {
      {"length_offset_missing", "a tool cuts without its length in force",
       "Error. The first move at the feed after a tool change is made with no tool length (G43) "
       "in\n"
       "force, though the tool table has one for the tool: the machine takes the spindle's face\n"
       "down to where the tip was meant. Example: `T1 M6`, `G0 X0 Y0`, `G1 Z-5 F200`.\n"
       "Remedy: G43 with the tool's H after every M6. If you touch off every tool, the table's\n"
       "lengths are 0 and nothing is told."},
      {"offset_left_on", "G92, G52 or a rotation outlives the program",
       "Warning. The control keeps G92 (and G52, which writes the same registers) and the "
       "rotation\n"
       "of a work system (G10 L2 R) over M2, M30 and a restart, so the next program runs "
       "displaced.\n"
       "Told when the program itself has set it. Example: `G92 X0` without `G92.1`.\n"
       "Remedy: G92.1, or G10 L2 P… R0, before the end."},
      {"speed_missing", "M3 or M4 without a speed",
       "Warning. The spindle is on when the tool first moves at the feed, but no S was given, so "
       "it\n"
       "turns at whatever the control had before, or not at all. Example: `M3`, `G1 X10 F100`."},
      {"spindle_speed_limit", "a speed that the tool or the spindle can't take",
       "S, or the limit D of G96, is above the tool's max_rpm (error: a tool that turns too fast\n"
       "flies apart), above the machine's highest speed or below its lowest, [spindle] rpm\n"
       "(warnings: the control slows down, refuses, or the spindle stalls). Looked at when the\n"
       "spindle turns and time passes, so an S for the next tool may stand before its M6."},
      {"spindle_stopped_cut", "a cut while the spindle stands still",
       "Without stock nobody knows whether a move at the feed cuts, so this is a warning at the\n"
       "first one after M5, M6 or the start; with the tool in material it would be an error.\n"
       "A tool with which the program probes (G38) is not told about.\n"
       "Example: `T1 M6`, `G43 H1`, `G1 Z-5 F200` without M3."},
      {"tool_change_spindle_on", "M6 while the spindle turns",
       "Information. LinuxCNC stops the spindle by itself at M6; other controls stop with an "
       "alarm.\n"
       "Example: `M3 S5000`, cuts, `T2 M6`. M5 before M6 is right everywhere."},
      {"wait_code", "the program waits for a signal from outside",
       "Warning. M66 with L1 to L4 waits for an input (of a second channel, a loader, a switch).\n"
       "When and whether it comes is not known here. Example: `M66 P0 L3 Q5`.\n"
       "Remedy: let the program look at #5399 afterwards, which is -1 after a timeout."},
  };
  return kinds;
}

bool is_semantic(const std::string& kind) {
  const auto& own = semantic_kinds();
  return std::any_of(own.begin(), own.end(),
                     [&](const KindText& row) { return kind == row.kind; }) ||
         std::find(interpreter_warnings.begin(), interpreter_warnings.end(), kind) !=
             interpreter_warnings.end();
}

}  // namespace aircut::semantics
