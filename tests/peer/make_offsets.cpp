#include "peer/program_maker.h"

namespace aircut::test {

void ProgramMaker::offset() {
  switch (below(11)) {
    case 0:
      add("G10 L2 P" + std::to_string(below(10)) + offset_words() + rotation());
      break;
    case 1:
      add("G10 L20 P" + std::to_string(below(10)) + offset_words());
      break;
    case 2:
      add(pick({"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"}));
      if (one_in(2)) add("G0" + axis_words(9));
      break;
    case 3:
      add("G92" + offset_words());
      break;
    case 4:
      add("G52" + offset_words());
      break;
    case 5:
      add(pick({"G92.1", "G92.2", "G92.3"}));
      break;
    case 6:
      add("(DEBUG,#5221 #5222 #5223 #5224 #5230 #5241 #5250 #5211 #5212 #5213 #5210 #5220)");
      break;
    case 7:
      // Of #5211 the reference knows at G92.3 only, but not for its idea of the current point.
      add("#" + pick({"5221", "5222", "5223", "5241"}) + "=" + decimal(-5, 5));
      if (one_in(2)) add(pick({"G54", "G55"}));
      break;
    case 8: {  // a system used, changed while in use, and left
      add(pick({"G55", "G59.1"}));
      add("G0" + axis_words(9));
      add("G10 L" + pick({"2", "20"}) + " P0" + offset_words());
      add("G0" + axis_words(9));
      add("G54");
      break;
    }
    case 9:
      add("G91 G10 L" + pick({"2", "20"}) + " P1" + offset_words());
      add("G90");
      break;
    default:
      add("G0" + axis_words(20));
      add("(DEBUG,#5420 #5421 #5422 #<_x> #<_y> #<_z> #<_abs_x> #<_abs_y> #<_abs_z>)");
  }
}

// The stand-in of the reference for a tool changer takes the point of the last move for the current
// one and forgets rotation and length offset (docs/peer.md), so a program has tool changes or
// rotation, and a move before the change.
void ProgramMaker::change_tool(int number) {
  if (rotates_) return add("T" + std::to_string(number));
  add("G49");
  add("G0 Z5");
  add("T" + std::to_string(number) + (one_in(2) ? " M6" : ""));
  if (!text_.ends_with(" M6\n")) add("M6");
  add("M3");
  has_tool_ = true;
  knows_tool_ = true;
}

// The stand-in takes tool 1 for loaded as long as none is, so tool 1 is left alone then.
std::string ProgramMaker::table_tool() { return std::to_string((has_tool_ ? 1 : 2) + below(2)); }

void ProgramMaker::tool_offset() {
  // The reference's stand-in does not convert the length offset in force at G20 and G21.
  if (changes_unit_) return offset();
  switch (below(8)) {
    case 0:
      add("G43 H" + std::to_string(1 + below(4)));
      break;
    case 1:
      add("G43.1" + offset_words());
      break;
    case 2:
      add("G49");
      break;
    case 3:
      if (knows_tool_) add(pick({"G43", "G43 H0"}));
      break;
    case 4:
      change_tool(1 + below(3));
      if (knows_tool_) add("(DEBUG,#5400 #5401 #5402 #5403 #5410 #5413)");
      break;
    case 5:
      add("G43.2 H" + std::to_string(1 + below(3)));
      break;
    case 6:  // the stand-in forgets the rotation then too
      if (rotates_) return offset();
      add("G49");
      add("G0" + axis_words(9));
      add("M61 Q" + std::to_string(1 + below(4)));
      knows_tool_ = false;
      break;
    default:
      add("G43 H2 G0" + axis_words(20));
  }
  if (one_in(3)) add("G0" + axis_words(20));
}

void ProgramMaker::tool_table() {
  if (changes_unit_) return offset();
  const std::string tool = table_tool();
  switch (below(4)) {
    case 0:
      add("G10 L1 P" + tool + offset_words() + (one_in(3) ? " R" + decimal(1, 5) : ""));
      break;
    case 1:
      add("G10 L1 P" + tool + pick({" R3", " I10 J20", " Q5", " R1.5 Q0", " I95 J155 Q2"}));
      break;
    case 2:
      add("G10 L10 P" + tool + offset_words() + (one_in(4) ? " R2" : ""));
      break;
    default:
      add("G10 L11 P" + tool + offset_words());
  }
  if (one_in(2)) add("G43 H" + tool);
  add("G0" + axis_words(9));
}

}  // namespace aircut::test
