#include "peer/program_maker.h"

namespace aircut::test {

void ProgramMaker::parameter() {
  switch (below(9)) {
    case 0:
      add("#" + std::to_string(1 + below(6)) + "=[" + expression(3) + "]");
      break;
    case 1:
      add("#" + std::to_string(1 + below(3)) + "=" + decimal(-9, 9) + " #" +
          std::to_string(1 + below(3)) + "=[#1+1] G0 X#1");
      break;
    case 2:
      add("#<" + pick({"a", "B c", "_global", "_Glo bal"}) + ">=[" + expression(2) + "]");
      break;
    case 3:
      add("(DEBUG,#1 #2 #3 #4 #5 #6 #<a> #<bc> #<_global> #<nobody>)");
      break;
    case 4:
      add("#[" + std::to_string(1 + below(4)) + "]=##" + std::to_string(1 + below(3)));
      break;
    case 5:
      add("#2=" + std::to_string(3 + below(3)) + " #3=2");
      add("###3=" + decimal(1, 9));
      add("#1=[##3 + #[#2 - 1]]");
      break;
    case 6:
      add("#" + std::to_string(31 + below(4969)) + "=" + number(-99, 99));
      add("(DEBUG,#31 #100 #4999 #5000 #5399)");
      break;
    case 7:
      add("(DEBUG,#<_metric> #<_imperial> #<_plane> #<_feed> #<_rpm> #<_motion_mode> "
          "#<_coord_system> #<_spindle_on> #<_spindle_cw> #<_mist> #<_flood> #<_ccomp> "
          "#<_tool_offset>)");
      break;
    default:
      add("(DEBUG,#<_absolute> #<_incremental> #<_inverse_time> #<_units_per_minute> "
          "#<_units_per_rev> #<_retract_old_z> #<_retract_r_plane> #<_spindle_rpm_mode> "
          "#<_spindle_css_mode>)");
      add("(DEBUG,#<_ijk_absolute_mode> #<_lathe_diameter_mode> #<_lathe_radius_mode> "
          "#<_speed_override> #<_feed_override> #<_adaptive_feed> #<_feed_hold> #<_call_level> "
          "#<_a> #<_b> #<_c> #<_abs_a> #<_selected_tool> #<_value> #<_value_returned>)");
  }
}

void ProgramMaker::flow() {
  switch (below(8)) {
    case 0:
    case 1:
      return branch();
    case 2:
    case 3:
    case 4:
      return loop();
    case 5:
      return fanuc_sub();
    case 6:
      return file_sub();
    default:
      return sub();
  }
}

void ProgramMaker::branch() {
  const std::string o = one_in(4) ? "o<if " + std::to_string(++labels_) + ">" : label();
  add(o + " if [" + expression(2) + "]");
  add("G0" + axis_words(10));
  if (one_in(4)) branch();
  for (int i = below(3); i > 0; --i) {
    add(o + " elseif [" + expression(1) + "]");
    add("G0" + axis_words(10));
  }
  if (one_in(2)) {
    add(o + " else");
    if (one_in(4)) loop();
    add("G0" + axis_words(10));
  }
  add(o + " endif" + (one_in(8) ? " (done)" : ""));
}

void ProgramMaker::loop() {
  const std::string o = one_in(6) ? "o<Loop" + std::to_string(++labels_) + ">" : label();
  const std::string counter = "#" + std::to_string(10 + labels_ % 15);
  switch (below(4)) {
    case 0:
      add(o + " repeat [" + pick({"2", "1.4", "2.6", "0", "-1", "3", "0.5"}) + "]");
      add("G91 G0" + axis_words(3));
      add("G90");
      if (one_in(4)) branch();
      return add(o + " endrepeat");
    case 1:
      add(counter + "=0");
      add(o + " do");
      add(counter + "=[" + counter + "+1]");
      if (one_in(3)) {
        const std::string inner = label();
        add(inner + " if [" + counter + " EQ 2]");
        add(o + " break");
        add(inner + " endif");
      }
      add("G0 Y" + counter);
      return add(o + " while [" + counter + " LT " + std::to_string(below(4)) + "]");
    default:
      add(counter + "=0");
      add(o + " while [" + counter + " LT " + std::to_string(below(4)) + "]");
      add(counter + "=[" + counter + "+1]");
      if (one_in(2)) {
        const std::string inner = label();
        add(inner + " if [" + counter + " EQ 2]");
        add(o + (one_in(2) ? " break" : " continue"));
        add(inner + " endif");
      }
      add("G0 X" + counter);
      if (one_in(5)) loop();
      add(o + " endwhile");
  }
}

void ProgramMaker::sub() {
  const bool named = one_in(3);
  const std::string o = named ? "o<Sub " + std::to_string(++labels_) + ">" : label();
  std::string body = o + " sub\n  G0 X#1 Y[#2*2] Z#3\n  #1=[#1+1] #31=[#31+1]\n";
  if (one_in(2)) body += "  (DEBUG,in #1 #2 #3 #30 #31 #<_call_level>)\n";
  if (one_in(4)) body += "  #<a>=3\n  (DEBUG,#<a>)\n";
  if (one_in(4))
    body += "  " + pick({"M73", "M70"}) + "\n  G91 F55\n  " + pick({"G55", "G98", "M8"}) + "\n";
  const std::string inner_loop = label();
  if (one_in(5))
    body += "  " + o + " if [#1 LT 3]\n    " + inner_loop + " repeat [2]\n  G91 G0 Z1\n    " +
            inner_loop + " endrepeat\n  " + o + " endif\n";
  // A call of itself, with one level less each time.
  if (one_in(4)) {
    const std::string inner = label();
    body += "  #9=[abs[#2]]\n  " + inner + " if [#9 GT 1]\n    " + o +
            " call [#1] [fix[#9]-2]\n  " + inner + " endif\n";
  }
  if (one_in(3)) body += "  " + o + " return [#1*3]\n";
  body += "  G90\n" + o + " endsub" + (one_in(2) ? " [#1+#31]" : "") + "\n";
  // A file that begins with % ends with the next one, and so do its subs.
  if (one_in(2))
    text_ += body;
  else
    subs_ += body;
  std::string call = !named && one_in(4) ? "o[" + o.substr(1) + "+0]" : o;
  call += " call [" + expression(1) + "] [" + decimal(-5, 5) + "]";
  for (int more = one_in(3) ? below(8) : 0; more > 0; --more) call += " [" + decimal(0, 3) + "]";
  add(call);
  add("G90 F100");
  add("(DEBUG,#1 #2 #31 #<_value> #<_value_returned> #<_call_level>)");
}

void ProgramMaker::fanuc_sub() {
  const std::string number = std::to_string(1000 + ++labels_);
  std::string body = "O" + number + "\n  #1=[#1+1]\n  G91 G0 X1 Y#1\n";
  if (one_in(4)) body += "  (DEBUG,#1 #<_call_level>)\n";
  // Each sub has labels of its own.
  if (one_in(4)) body += "  o1 if [#1 GT 2]\n    G0 Z2\n  o1 else\n    M8\n  o1 endif\n";
  if (one_in(4)) {
    const std::string inner = std::to_string(1000 + ++labels_);
    body += "  M98 P" + inner + " L2" + pick({"", " (MSG,inner)"}) + "\n";
    body += "M99\nO" + inner + "\n  G0 Z1\n  M99\n";
  } else {
    body += "  M99\n";
  }
  subs_ += body;
  const std::string repeats = pick({"", " L2", " L3", " L1"});
  add((one_in(12) ? pick({"N5 ", "G4 P1 ", "(c)"}) : "") + "M98 P" + number + repeats +
      (one_in(8) ? " (DEBUG,#1)" : ""));
  if (one_in(6)) add("M98 P" + number);
  add("G90");
}

void ProgramMaker::file_sub() {
  const std::string file = pick({"mover", "box", "box", "turner"});
  add("o<" + file + "> call [" + number(-9, 9) + "] [" + decimal(1, 5) + "]" +
      (one_in(2) ? " [" + std::to_string(below(4)) + "]" : ""));
  add("(DEBUG,#1 #<_value> #<_value_returned>)");
}

void ProgramMaker::stack() {
  add(pick({"M70", "M73"}));
  add(changes_unit_ && one_in(5)
          ? "G20"
          : pick({"G91", "G55", "F33", "G98", "G90.1", "G61", "S50", "M5", "G7", "G18", "M8", "M49",
                  "G96 S100 D500", "G95 F0.5", "G64 P0.1", "M53 P0", "M52 P1"}));
  if (one_in(3)) add(pick({"G91", "G56", "F44", "M7", "M4"}));
  if (one_in(6)) add("M71");
  if (!one_in(3)) add("M72");
  plane_ = 0;
  add("G17 G90 G54 G21 G8 G91.1 G94 F100");
  add("G97 M3 S100");
}

}  // namespace aircut::test
