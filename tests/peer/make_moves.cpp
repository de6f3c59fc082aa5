#include "peer/program_maker.h"

namespace aircut::test {

void ProgramMaker::line_move() {
  std::string line = pick({"G0", "G1", "G1", "G00", "g 1", "G01"}) + axis_words(30) + feed();
  if (one_in(12)) line = "G53 " + line;
  if (one_in(8)) line += " F" + std::to_string(10 + below(300));
  if (one_in(15)) line += " (a comment)";
  if (one_in(20))
    line +=
        " G" + (changes_unit_ ? pick({"90", "91", "20", "21", "17"}) : pick({"90", "91", "17"}));
  if (one_in(12)) line += " M" + pick({"3", "4", "7", "8", "9"});
  if (one_in(30)) line = "/" + line;
  add(line);
  if (one_in(6)) add(axis_words(30).substr(1) + feed());
}

std::string ProgramMaker::third_axis() {
  return (plane_ == 0 ? " Z" : plane_ == 1 ? " Y" : " X") + decimal(-10, 10);
}

std::string ProgramMaker::ends(const std::string& a, const std::string& b) {
  static constexpr const char* names[3][2] = {{" X", " Y"}, {" X", " Z"}, {" Y", " Z"}};
  return names[plane_][0] + a + names[plane_][1] + b;
}

std::string ProgramMaker::centre(const std::string& a, const std::string& b) {
  static constexpr const char* names[3][2] = {{" I", " J"}, {" I", " K"}, {" J", " K"}};
  return names[plane_][0] + a + names[plane_][1] + b;
}

void ProgramMaker::arc() {
  const std::string turn = pick({"G2", "G3", "G2", "G3", "G02"});
  const std::string extra = (one_in(6) ? " P" + std::to_string(1 + below(3)) : "") +
                            (one_in(4) ? third_axis() : "") +
                            (one_in(8) ? pick({" A", " B", " C"}) + decimal(-50, 50) : "") + feed();
  switch (below(14) == 0 ? 6 : below(6)) {
    case 0:  // a full circle
      add(turn + " " + centre(decimal(1, 20), decimal(-20, 20)) + extra);
      break;
    case 1: {  // half a turn, incremental: the centre lies in the middle of the way
      const int a = 2 * (1 + below(10)), b = 2 * (below(20) - 10);
      add("G91 " + turn + ends(std::to_string(a), std::to_string(b)) +
          centre(std::to_string(a / 2), std::to_string(b / 2)) + extra);
      add("G90");
      break;
    }
    case 2: {  // three quarters or a quarter
      const std::string r = std::to_string(1 + below(20));
      add("G91 " + turn + ends(r, r) + centre(r, "0") + extra);
      add("G90");
      break;
    }
    case 3:  // radius form, from the point before
      add("G91 " + turn + ends(decimal(-9, 9), decimal(1, 9)) + " R" +
          pick({"12", "-12", "9.5", "20", "5", "-7", "100.5"}) + extra);
      add("G90");
      break;
    case 4:  // absolute centre
      add("G90.1 " + turn + centre(decimal(-20, 20), decimal(-20, 20)) + extra);
      add("G91.1");
      break;
    case 5: {  // nearly right, at the limit of the tolerance
      add("G0" + ends("0", "0"));
      const std::string end = pick({"10.02", "10.03", "9.975", "10.0029", "9.99", "10"});
      add(turn + ends("10", end) + centre("10", "0") + extra);
      break;
    }
    default:  // anything
      add(turn + axis_words(20) + pick({" I5", " J3", " I4 J2", " K3", " R15", " I1 R3"}) + extra);
  }
}

void ProgramMaker::polar() {
  plane_xy();
  add("G0 X" + decimal(1, 20) + " Y" + decimal(1, 20));
  add("G1 @" + decimal(1, 20) + " ^" + decimal(-180, 180) + feed());
  if (one_in(2)) add("G1 ^" + decimal(-180, 180) + (one_in(3) ? " Z1" : "") + feed());
  if (one_in(2)) add("G0 @" + decimal(1, 20));
  if (one_in(3)) {
    add("G91 G1 @" + decimal(1, 5) + " ^" + decimal(-90, 90) + feed());
    add("G90");
  }
  if (one_in(4))
    add(pick({"G2", "G3"}) + " @10 ^" + decimal(10, 80) + " R" + decimal(25, 60) + feed());
  if (one_in(4) && !inverse_time_) {
    if (changes_unit_) add("G0 Z" + decimal(2, 5));
    add("G81 @" + decimal(5, 9) + " ^" + decimal(0, 90) + " Z-2 R1");
    add("^" + decimal(0, 360));
    add("G80");
  }
}

void ProgramMaker::spline() {
  plane_xy();
  switch (below(4)) {
    case 0:
      add("G5 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " I1 J2 P-1 Q2" + feed());
      if (one_in(2)) add("G5 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " P-1 Q2" + feed());
      if (one_in(3)) add(pick({"X", "X2 Y", "G91 X"}) + decimal(1, 9));
      if (one_in(5)) add("(DEBUG,#<_motion_mode>)");
      if (one_in(3)) add("G90");
      break;
    case 1:
      add("G5.1 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " I1 J2" + feed());
      if (one_in(3)) add("G91 G5.1 X" + decimal(1, 9) + " I2 J" + decimal(-3, 3) + feed());
      if (one_in(3)) add("G90");
      break;
    default: {
      if (inverse_time_) return;
      const bool incremental = one_in(4);
      add((incremental ? "G91 " : "") + ("G5.2 X" + decimal(1, 4)) + " Y" + decimal(1, 4) + " P" +
          pick({"1", "2", "0.5"}) + pick({"", " L3", " L4", " L2", " L1"}));
      for (int i = 2 + below(4); i > 0; --i)
        add("X" + decimal(-9, 9) + " Y" + decimal(-9, 9) + " P" + pick({"1", "2", "0.5"}) +
            (one_in(8) ? pick({" L3", " L4", " L5"}) : ""));
      add("G5.3");
      if (incremental) add("G90");
    }
  }
  add("G0 X" + decimal(1, 9));
}

void ProgramMaker::modal() {
  switch (below(10)) {
    case 0:
      plane_ = below(3);
      add("G1" + std::to_string(7 + plane_));
      break;
    case 1:
      add(changes_unit_ ? pick({"G20", "G21", "G21"}) : "G21");
      break;
    case 2:
      add("G91");
      add("G1" + axis_words(5) + feed());
      if (one_in(2)) add("G0" + axis_words(5));
      if (one_in(3)) add(axis_words(5).substr(1));
      add("G90");
      break;
    case 3:
      add(pick({"G61", "G61.1", "G64", "G64 P0.1", "G64 P0.05 Q0.02", "G64 Q0.1", "G64 P0"}));
      break;
    case 4:
      add(pick({"G98", "G99"}));
      break;
    case 5:
      add("F" + std::to_string(10 + below(200)));
      break;
    case 6:  // planes of axes that this machine lacks
      add(pick({"G17.1", "G18.1", "G19.1"}));
      add("G0" + axis_words(9));
      plane_ = 0;
      add("G17");
      break;
    case 7:  // one line with much on it
      add("G" + pick({"0", "1"}) + " G" + pick({"54", "55", "59"}) + " G" + pick({"61", "64"}) +
          " G90 G" + pick({"98", "99"}) + " M" + pick({"7", "8", "9"}) + " M" + pick({"48", "49"}) +
          " S" + std::to_string(100 + below(900)) + axis_words(9) + feed());
      add("M48");
      break;
    default:
      add(pick({"G80", "G0", "G1", "G90 G17 G94 F100", "G40 G49 G80"}));
      if (text_.ends_with("F100\n")) plane_ = 0, inverse_time_ = false;
  }
}

void ProgramMaker::feed_mode() {
  switch (below(3)) {
    case 0:
      inverse_time_ = true;
      add("G93");
      add("G1" + axis_words(20) + feed());
      add("G2 " + centre("3", "4") + feed());
      if (one_in(2)) arc();
      inverse_time_ = false;
      break;
    case 1:
      add("G95 F0." + std::to_string(1 + below(9)));
      add("G1" + axis_words(20));
      if (one_in(2)) cycle();
      break;
    default:
      add("G96 S" + std::to_string(50 + below(200)) + (one_in(2) ? " D2000" : ""));
      add("G95 F0.2");
      add("G1" + axis_words(9));
      add("G97 S300");
  }
  add("G94 F" + std::to_string(10 + below(200)));
}

void ProgramMaker::home() {
  const std::string at = one_in(4) ? "G91 " : "";
  switch (below(7)) {
    case 0:
      add(at + "G28" + (one_in(2) ? axis_words(10) : ""));
      break;
    case 1:
      add(at + "G30" + (one_in(2) ? axis_words(10) : ""));
      break;
    case 2:
      add("G28.1");
      break;
    case 3:
      add("G30.1");
      break;
    case 4:
      add("G0" + axis_words(20));
      add(pick({"G28.1", "G30.1"}));
      add("G0" + axis_words(20));
      add(at + pick({"G28", "G30"}) + axis_words(5));
      break;
    case 5:
      add("(DEBUG,#5161 #5162 #5163 #5164 #5181 #5182 #5183 #5186)");
      break;
    default:
      add("G53 G" + pick({"0", "1"}) + axis_words(20) + feed());
  }
  if (!at.empty()) add("G90");
}

void ProgramMaker::probe() {
  if (inverse_time_) return;
  // The reference stops short of the end, so the point is given anew.
  add(pick({"G38.2", "G38.3", "G38.4", "G38.5"}) + axis_words(20) + pick({" F20", "", " F100"}));
  add("G90 G0 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " Z" + decimal(1, 9) + " A0 B0 C0");
}

void ProgramMaker::lathe() {
  switch (below(4)) {
    case 0:
      add("G7");
      add("G0" + axis_words(20));
      add("G91 G0 X2");
      add("G90");
      if (plane_ != 2) add("G2 " + centre("2", "3") + feed());
      if (one_in(3)) {
        add("G92 X" + decimal(1, 9));
      }
      if (one_in(3)) add("G10 L20 P1 X" + decimal(1, 9));
      add("(DEBUG,#5420 #<_x>)");
      add("G8");
      break;
    case 1:
      add("M3 S100");
      add("G33" + axis_words(20) + " K" + decimal(1, 3) + (one_in(4) ? " $0" : ""));
      if (one_in(2)) add("Z" + decimal(-9, 9) + " K2");
      add("G0" + axis_words(20));
      break;
    case 2:
      add("M3 S100");
      add("G33.1" + axis_words(20) + " K" + decimal(1, 3) + (one_in(3) ? " I2" : ""));
      add("G0" + axis_words(20));
      break;
    default:
      add("G96 D2000 S150");
      add("G97 S300");
  }
}

void ProgramMaker::thread() {
  const bool diameter = one_in(4);
  add("M" + pick({"3", "3", "4"}) + " S300");
  if (diameter) add("G7");
  if (one_in(3)) {
    plane_ = 1;
    add("G18");
  }
  add("G0 X12 Z3");
  const bool incremental = one_in(6);
  add((incremental ? "G91 " : "") + ("G76 P" + decimal(1, 2)) + " Z" + decimal(-30, -10) + " I" +
      pick({"-2", "-1", "3"}) + " J0." + std::to_string(2 + below(5)) + " K" +
      pick({"0.93", "1.27", "1.01", "0.9", "1.2"}) +
      (one_in(2) ? " R" + pick({"1", "1.5", "2", "0.5"}) : "") +
      (one_in(2) ? " Q" + pick({"29.5", "30", "0"}) : "") +
      (one_in(2) ? " H" + std::to_string(below(3)) : "") +
      (one_in(3) ? " E" + pick({"1", "2"}) + " L" + std::to_string(below(4)) : "") +
      (one_in(6) ? " $0" : ""));
  if (incremental) add("G90");
  if (diameter) add("G8");
  add("G0" + axis_words(9));
}

}  // namespace aircut::test
