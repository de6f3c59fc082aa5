// The kinds of messages of the interpreter with their long text. Each has a program that provokes
// it: tests/interp/errors/KIND.ngc.
#include "interp/interp.h"

namespace aircut::interp {

const std::vector<KindText>& error_kinds() {
  static const std::vector<KindText> kinds = {
      {"alarm", "the program stopped itself",
       "The program asked for its own end with (ABORT, text), usually because a check in it "
       "failed. Example: `(ABORT, no stock)`. Read the text and what led to the line."},
      {"ambiguous_logic", "AND, OR, XOR beside a comparison without brackets",
       "Warning. On Fanuc-like controls AND binds as close as * and OR as +, so `[#1 EQ 1 AND #2 "
       "EQ "
       "2]` compares #1 with `1 AND #2`. Write `[[#1 EQ 1] AND [#2 EQ 2]]`."},
      {"arc_error", "an arc whose geometry does not work",
       "The end must lie on the circle that centre (I J K) or radius (R) give, in the plane in "
       "force. Example: `G2 X10 Y0 I4` from X0 ends 2 mm off the circle; right is `I5`. Check the "
       "plane (G17 G18 G19), G90.1, and the point where the arc begins."},
      {"axis_conflict", "two codes want the axis words of one line",
       "G10, G28, G30, G52 and G92 use the axis words themselves, so no motion code can stand with "
       "them. Example: `G1 G92 X0`. Use two lines."},
      {"axis_unknown", "a word of an axis that the machine lacks",
       "Only the axes of the machine can be programmed. Example: `G0 V5` on a machine with X Y Z."},
      {"axis_word_missing", "a code without its axis words",
       "Codes such as G92, G81 or G38.2 need at least one axis word. Example: `G92`; right is `G92 "
       "X0`."},
      {"axis_word_unused", "axis words without a code that moves",
       "At the start and after G80 no motion is in force. Example: `X10` as the first line; right "
       "is `G0 X10`."},
      {"bad_character", "a character that can't stand there",
       "Lines are made of words (a letter and a number), settings (#1=2) and comments. Example: "
       "`G0 X1 ?`."},
      {"bad_comment", "a comment that is nested or not closed",
       "Comments stand in ( ) on one line and can't be nested; `;` begins one that runs to the "
       "end. Example: `(a (b) c)`."},
      {"bad_expression", "an expression that can't be read",
       "Brackets must match, operators stand between values. Example: `X[1+]`, `X[1`."},
      {"bad_label", "an O-word without a usable label",
       "A label is a number, a <name> or an [expression] with an integer value. Example: `o1.5 if "
       "[1]`."},
      {"bad_number", "a number that can't be read, or none",
       "A number has digits and at most one point; no comma, no exponent. Example: `X1.2.3`, `X` "
       "alone."},
      {"bad_parameter_name", "a parameter name that is empty or not closed",
       "Names stand between < and >. Example: `#<depth = 3`."},
      {"call_depth", "calls nested deeper than the control takes",
       "Nine calls may be open at once. A sub that calls itself must end some time. Example: `o1 "
       "sub / o1 call / o1 endsub`."},
      {"code_accepted", "a code that moves nothing and is not modelled",
       "Information. Smoothing, doors, chip conveyors and the like change no path here. Example: "
       "`G187 P2`."},
      {"comp_arc", "the tool does not fit inside an arc",
       "With G41/G42 an arc on whose inside the tool runs needs a larger radius than the tool's. "
       "Example: a pocket corner of radius 2 with a 6 mm cutter. Use a smaller tool."},
      {"comp_entry", "radius compensation can't begin with this move",
       "The first move after G41/G42 must be longer than the tool's radius (a line), or have a "
       "larger radius (an arc). Example: `G41.1 D10` and then `G1 X3`."},
      {"comp_exit_short", "a short move ends radius compensation",
       "Warning. The move after G40 is shorter than the tool's diameter, so the tool may cut into "
       "the contour. Leave with a longer move."},
      {"comp_gouge", "the tool does not fit into an inside corner",
       "The offset moves do not meet, or a move is too short between its corners. Use a smaller "
       "tool or a longer move."},
      {"comp_illegal", "not allowed while radius compensation is on",
       "Planes, offsets, cycles, probing, tool changes and others must wait for G40. Example: `G41 "
       "D1` and then `G55`."},
      {"contour_error", "a contour that a turning cycle can't cut",
       "G70, G71, G72 and G73 need a contour of G0 to G3 moves in X and Z that does not go back on "
       "its way. Example: `G71 Q100` with a sub o100 that goes to Z-10 and back to Z-5."},
      {"control_fault", "the control itself goes wrong here",
       "Warning. LinuxCNC is known to mishandle this, and the result shows what it does: a do loop "
       "behind a break runs once only; G10 L2 with a new R while G92 or G52 is in force misplaces "
       "the current point. Example: `G92 X5` and then `G10 L2 P1 R90`. Write it in another way."},
      {"comp_rapid", "a rapid begins or ends radius compensation",
       "Warning. The first move after G41/G42 and the first after G40 run obliquely to and from "
       "the "
       "contour; as a rapid that cuts in at full speed, also when only Z is given. Example: `G40` "
       "and then `G0 Z50`. Use G1 for both."},
      {"control_setting", "what a line does depends on a setting of the control",
       "Warning. Controls differ here, by a parameter. The message says what was taken to be "
       "meant; "
       "write it so that it means the same everywhere. Example: a first move with X alone behind "
       "G68."},
      {"corner_error", "a corner or a line by its angle that can't be made",
       "`,R` rounds and `,C` cuts off the corner between a block and the next one, which must be a "
       "move of G1 to G3 in the same plane and long enough; on lathes R C I K without a comma do "
       "the same, and `,A` gives a line by its angle. Example: `G1 X10. ,R20.` and then `Y5.`."},
      {"cycle_error", "a canned cycle that can't be carried out",
       "R must lie above the bottom, rotary axes can't move in it, G93 is not possible. Example: "
       "`G81 X1 R-5 Z-1`."},
      {"cycle_modal_change", "the plane or unit changes within a group of canned cycles",
       "Warning. A group lasts until G80 or another motion code. A change of plane (G17 G18 G19) "
       "inside it leaves the level to retract to on another axis, a change of unit (G20 G21) the "
       "kept R, depth and Q in doubt. Example: `G81 X1 Y1 Z-5 R2`, `G20`, `X1`. Give G80 first."},
      {"decimal_point", "a number without a decimal point counts increments",
       "Warning. On Fanuc-like controls X10 is 0.010 mm or 0.0010 in, X10. is 10. Write the point, "
       "or "
       "say that the control reads whole units (--whole-units). Only the first 20 words are told. "
       "Example: `G0 X10`."},
      {"dialect_chosen", "which dialect was chosen, and why",
       "Info. With --dialect auto the program's text decides whose control reads it. Name the "
       "dialect "
       "when the choice is wrong. Example: a program with GOTO is read as Fanuc's."},
      {"duplicate_word", "a letter twice on a line",
       "Each letter but G and M may stand once. Example: `G0 X1 X2`."},
      {"dwell_time", "a dwell of less than no time",
       "G4 P and P of cycles are seconds, 0 or more. Example: `G4 P-2`."},
      {"empty_program", "a program without any line",
       "The text holds nothing but blanks. It needs at least M2."},
      {"encoding", "a text that the control can't read",
       "Programs are plain text: no byte order mark, no UTF-16, no binary data. Save the file as "
       "UTF-8 without a mark."},
      {"fanuc_subs_off", "M98 or a bare O-number where the machine's set-up forbids them",
       "DISABLE_FANUC_STYLE_SUB is set. Use `o… sub`, `o… endsub` and `o… call`. Example: `M98 "
       "P100`."},
      {"feed_before_unit", "F acts before the change of units on its line",
       "Warning. F runs before G20 and G21, so it is read in the old unit. Example: `G20 F10 G1 "
       "X1` in a metric program feeds 10 mm/min. Put G20 on a line before."},
      {"feed_missing", "no F on a line of inverse time",
       "With G93 F is the time of one move, so every G1, G2 and G3 line needs its own."},
      {"flow_nesting", "a sub inside a sub",
       "Definitions of subs stand one behind the other. Example: `o1 sub / o2 sub`."},
      {"flow_syntax", "an O-word used in a wrong way",
       "A condition is missing, something else stands on the line, or return, break, M98 or M99 "
       "are out of place. Example: `o1 if` without `[…]`."},
      {"frame_error", "mirror image, scaling or rotation used in a wrong way",
       "G51.1, G51 and G68 are given in this order and taken back in the other; while one is on, "
       "the "
       "plane, the work system and the reference points can't be used, and an arc needs the same "
       "factor for both axes. Example: `G68 X0 Y0 R30` and then `G55`."},
      {"frame_left_on", "rotation, scaling, mirror image or G16 left on",
       "Warning. G68, G51, G51.1 or G16 is on at a tool change or at the end of the program. "
       "Whether the end takes it back is a parameter of the control; the next tool or program may "
       "run turned or mirrored. Give G69, G50, G50.1 or G15 before. Example: `G68 X0 Y0 R30.`, "
       "`M30`."},
      {"g10_error", "G10 with words that do not belong together",
       "L2 and L20 set work systems (P0-P9, no I J), L1, L10 and L11 tools. Example: `G10 L2 P12 "
       "X0`."},
      {"g53_error", "G53 where it can't be used",
       "Machine coordinates need G90, G0 or G1, and no radius compensation. Example: `G91 G53 G0 "
       "Z0`."},
      {"indexer_move", "a clamped (indexing) axis that can't be moved so",
       "Such an axis is unlocked for a G0 of its own. Example: `G0 X1 A90`, `G1 A90`. Give it a "
       "line of its own."},
      {"io_error", "M66 with words that do not fit",
       "M66 takes P (digital) or E (analog), and Q above 0 when it waits. Example: `M66 P1 E1`."},
      {"label_missing", "an O-word without its other half",
       "if needs endif, while endwhile, sub endsub, each with the same label. Example: `o1 while "
       "[1]` without `o1 endwhile`."},
      {"label_reused", "a label used for two blocks",
       "Within a sub or the main program each loop and branch needs a label of its own. Example: "
       "`o1 if` twice."},
      {"limit_reached", "a limit of this run",
       "Too many blocks, files, names or moves. What came before stands. Raise the limit when the "
       "program is meant to be so large. Example: a G83 with a peck of a nanometre."},
      {"line_too_long", "a line of more than 252 characters",
       "The control refuses such lines. Split it; long comments too."},
      {"loop_limit", "a loop that does not end",
       "The loop ran to a limit. The message shows its condition's parameters. Example: `o1 while "
       "[1]`."},
      {"math_domain", "a function or operator outside its range",
       "Division by 0, SQRT of a negative number, ACOS of more than 1, results that are not "
       "finite. Example: `[1/#1]` with #1 = 0."},
      {"manual_retract", "a cycle whose tool is drawn out by hand",
       "Warning. G88 feeds to the bottom, dwells, and stops there until the operator has moved the "
       "tool out; the control goes on as if it were at the level of retraction. Nothing in the "
       "program moves it, so here the next move begins at the bottom. Use G86 or G89. Example: "
       "`G88 X1 Z-1 R1 P0.5`."},
      {"misplaced_word", "N or an O-word that is not the first word",
       "N stands first, then an O-word. Example: `G0 N10`."},
      {"mixed_block", "words and a macro statement in one block",
       "Fanuc-like controls take either words or settings, IF, GOTO, WHILE, DO and END in a block. "
       "Example: `G0 X1. #1=5`. Use two blocks."},
      {"modal_clash", "two codes of one group on a line",
       "Only one of a group can act. Example: `G0 G1 X1`, `M7 M8`. Use two lines."},
      {"modal_stack", "M72 without anything saved",
       "M72 restores what M70 saved in the same sub. Example: M72 as the first line."},
      {"parameter_line", "a line of a parameter file that is ignored, wholly or in part",
       "Warning. A line holds a parameter's number and its value; the control passes over anything "
       "else, so a value that is misspelt stays 0 or is cut. Example: `5221 1o0` gives 1."},
      {"parameter_order", "a parameter file whose numbers do not ascend",
       "Every line of the file holds a number and a value, the numbers ascending. Sort the file."},
      {"parameter_range", "a parameter number that does not exist",
       "Numbers are integers from 1 to 5601. Example: `#0=1`, `#6000`."},
      {"parameter_read_only", "a parameter that can't be set",
       "Positions, tool data and predefined names follow from the machine's state. Example: "
       "`#5420=1`, `#<_x>=1`."},
      {"parameter_undefined", "a named parameter without a value",
       "Set a name before it is read; names without a leading _ are known only in their own sub. "
       "Example: `G0 X#<lenght>`."},
      {"path_refused", "a sub's name that leaves its folder",
       "Called files lie in the program's folder or the sub path. Example: `o</etc/x> call`, "
       "`o<../x> call`."},
      {"percent_missing", "the closing % is missing",
       "A program that begins with a line % must end with one. Add it, or remove the first."},
      {"polar_error", "polar words that can't be used so",
       "@ and ^ need G17, no X Y on the line, and an angle that is defined. Example: `G18 G0 @10 "
       "^0`. Fanuc: between G16 and G15 the plane's words are radius and angle; both must be "
       "known."},
      {"probe_error", "a probing move that can't be made",
       "G38 needs G94 and another end than the current point. Example: `G38.2 X0` at X0."},
      {"program_end_missing", "the program does not end",
       "Add M2 or M30 as the last line, or put the program between % lines."},
      {"program_restart", "M99 in the main program",
       "Info. The control would start the program again and again; one pass is executed here. End "
       "with "
       "M30 when it is to run once."},
      {"reference_error", "a reference point that is not known or not reached",
       "G30 P2 to P4 need the machine's points from the parameter file (#5181, #20181, #20201), "
       "G29 "
       "a G28 before, G27 must end at the point. Example: `G29 X0` as the first move."},
      {"remap_words", "a remapped code without the words that its REMAP line asks for",
       "A capital letter in argspec= is a word that must be there, `>` asks for F and `^` for S "
       "above 0. Example: `M400` with argspec=P."},
      {"retained_offset", "a length offset that the machine does not take",
       "Warning. With RETAIN_G43 the tool in the spindle says the offset as long as G43 is on. "
       "Example: `G43 H2` with tool 1 in the spindle, `G49`."},
      {"shared_axis_words", "axis words used for an offset and a move",
       "Warning. In `G43.1 Z1 G0 X3` both words set the offset and are the end of the move. Use "
       "two lines."},
      {"spindle_stopped", "a code that needs a turning spindle",
       "G33, G76, G74, G84, G86 need it, G74 and G84 in the right direction, and G95 needs a "
       "speed. Example: `G33 Z-5 K1` without M3."},
      {"spindle_unknown", "a spindle that the machine lacks",
       "$ counts from 0; -1 means all. Example: `M3 $4`."},
      {"spline_error", "a spline with words that do not fit",
       "G5 needs P Q (and I J or none), G5.1 I J, G5.2 lines weights; X and Y in G17 only. "
       "Example: `G5 X1 Y1`."},
      {"sub_missing", "a call of a sub that is nowhere",
       "It must be in this program or in a file of its name in the program's folder or the sub "
       "path. Example: `o<drill> call`."},
      {"sub_reached", "the main program runs into a sub",
       "A sub that was called before its definition must lie behind the end of the main program. "
       "Example: no M2 before `o1 sub`."},
      {"thread_error", "a thread with impossible words",
       "The pitch (K of G33 and G33.1, P of G76) is above 0. G76: I is not 0, J above 0, K above "
       "J, tapers shorter than the thread. Example: `K` smaller than `J`."},
      {"too_many_m", "more than four M words",
       "Put the others on a line of their own. Example: `M3 M8 M48 M64 P1 M0`."},
      {"time_unknown", "a timer that is read before the run",
       "Warning. What the timers #3001 and #3002 would show is not known when the program is read; "
       "they count 1 ms per block here, so that loops that wait for them end."},
      {"tool_not_selected", "M6 without a tool selected",
       "Warning. M6 before any T word empties the spindle. Give T before."},
      {"tool_unknown", "a tool that is not in the table",
       "T, H, D and G10 L1 name tools of the tool table. Example: `T77`."},
      {"unknown_code", "a G or M code that does not exist",
       "Check the number; codes of other controls may be missing here. Example: `G12`."},
      {"unknown_function", "a function that does not exist",
       "Known are ABS ACOS ASIN ATAN COS EXISTS EXP FIX FUP LN ROUND SIN SQRT TAN. Example: "
       "`sine[30]`."},
      {"unknown_keyword", "an O-word with an unknown keyword",
       "Known are sub endsub call return if elseif else endif while endwhile do repeat endrepeat "
       "break continue. Example: `o1 wile [1]`."},
      {"unknown_operator", "an operator that does not exist",
       "Known are ** * / MOD + - EQ NE GT GE LT LE AND OR XOR. Example: `[1 is 2]`."},
      {"unsupported_code", "a code that is known but not implemented",
       "The control knows it, this program does not, so the line can't be checked. Example: G6.2."},
      {"word_ignored", "a code without the word that makes it act",
       "Warning. Example: M19 without R does not move the spindle."},
      {"word_missing", "a word that the code needs",
       "Example: `G4` without P, `G33 Z-5` without K."},
      {"word_unused", "a word that no code of the line uses",
       "Remove it or add the code that it belongs to. Example: `G0 X1 H5`. `X1e3` is the number 1 "
       "and the word E3."},
      {"word_value", "a word outside its range",
       "Example: `G2 … P0` (turns are 1 or more), `S-5`, an H word that is not an integer."},
      {"wrapped_axis", "a position of a wrapped axis beyond one turn",
       "In G90 such an axis takes -359.999… to 359.999…, the sign says the way. Example: `G0 "
       "A400`. Use G91 for more turns."},
      {"wrapped_offset", "a wrapped axis that stops at another machine angle than the one named",
       "Warning. The control takes offsets off a machine position before it chooses the turn, and "
       "loses the sign. Example: `G53 G0 A20` with 30 degrees in G54."},
      {"wrong_offset", "the length or diameter of another tool",
       "H (error) or D (warning) names another tool than the one in the spindle when the machine "
       "next moves, or the length of the tool before is still in force at the first cut. A wrong "
       "length drives the tool into the work, a wrong diameter makes the contour too large or too "
       "small. Example: `T2 M6`, `G43 H1`. On purpose: --waive wrong_offset=REASON."},
      {"zero_feed", "a feed move without a feed",
       "G1, G2, G3, probing and cycles need F above 0; G93, G94 and G95 forget the one before. "
       "Example: `G1 X1` as the first line."},
  };
  return kinds;
}

}  // namespace aircut::interp
