// Each line comes from one of a few families. The generator keeps only what it needs to make most
// lines right (a feed is set, the spindle turns, distances are absolute); the rest is for the two
// interpreters to agree on. Every family also makes lines that are sometimes wrong.
#include "peer/generator.h"

#include <array>
#include <random>
#include <string>
#include <vector>

namespace aircut::test {
namespace {

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  std::string program() {
    using Family = void (Generator::*)();
    static constexpr std::array<Family, 30> families = {
        &Generator::line_move,   &Generator::line_move,    &Generator::line_move,
        &Generator::line_move,   &Generator::arc,          &Generator::arc,
        &Generator::arc,         &Generator::modal,        &Generator::modal,
        &Generator::feed_mode,   &Generator::offset,       &Generator::offset,
        &Generator::offset,      &Generator::tool_offset,  &Generator::cycle,
        &Generator::cycle,       &Generator::cycle,        &Generator::parameter,
        &Generator::parameter,   &Generator::flow,         &Generator::flow,
        &Generator::polar,       &Generator::machine_code, &Generator::machine_code,
        &Generator::compensated, &Generator::home,         &Generator::lathe,
        &Generator::spline,      &Generator::hostile,      &Generator::stack};
    rotates_ = one_in(2);
    changes_unit_ = one_in(2);
    add("F" + std::to_string(50 + below(200)) + " S300 M3");
    if (below(4) == 0) add("G10 L2 P1 " + offset_words() + rotation());
    if (below(4) == 0) change_tool(1 + below(2));
    const int count = 6 + below(14);
    for (int i = 0; i < count; ++i) (this->*families[below(families.size())])();
    add("(DEBUG,end #5420 #5421 #5422)");
    text_ += "M2\n" + subs_;
    return text_;
  }

 private:
  // ---- chance
  template <class T>
  int below(T limit) {
    return static_cast<int>(random_() % static_cast<std::uint32_t>(limit));
  }
  bool one_in(int n) { return below(n) == 0; }
  std::string pick(std::initializer_list<const char*> words) {
    return *(words.begin() + below(words.size()));
  }

  // ---- text
  void add(const std::string& line) {
    ++line_;
    const bool oword = line[0] == 'o';
    text_ += (oword ? "" : "N" + std::to_string(line_) + " ") + line + "\n";
  }
  std::string decimal(int from, int to) {
    std::string sign;
    int value = from * 100 + below((to - from) * 100 + 1);
    if (one_in(3)) value = value / 100 * 100;
    if (value < 0) sign = "-", value = -value;
    std::string text = sign + std::to_string(value / 100);
    if (value % 100 != 0)
      text += "." + std::to_string(value % 100 / 10) + std::to_string(value % 10);
    return text;
  }
  /// A number in one of its spellings; its value lies between `from` and `to`, mostly.
  std::string number(int from, int to) {
    switch (below(12)) {
      case 0:
        return "[" + decimal(from, to) + "]";
      case 1:
        return "[" + decimal(from, to) + " + #" + std::to_string(1 + below(4)) + " / 4]";
      case 2:
        return "#" + std::to_string(1 + below(4));
      case 3:
        return "[" + expression(2) + "]";
      default:
        return decimal(from, to);
    }
  }
  std::string expression(int depth) {
    if (depth == 0 || one_in(4)) {
      switch (below(5)) {
        case 0:
          return "#" + std::to_string(1 + below(6));
        case 1:
          return "-" + std::to_string(below(5));
        case 2:
          return "#[1+" + std::to_string(below(3)) + "]";
        default:
          return decimal(-5, 9);
      }
    }
    switch (below(12)) {
      case 0:
        return pick({"sin", "cos", "abs", "fix", "fup", "round"}) + "[" + expression(depth - 1) +
               "]";
      case 1:
        return "sqrt[abs[" + expression(depth - 1) + "]]";
      case 2:
        return "atan[" + expression(depth - 1) + "]/[" + expression(depth - 1) + "]";
      case 3:
        return "[" + expression(depth - 1) +
               pick({" EQ ", " NE ", " LT ", " LE ", " GT ", " GE "}) + expression(depth - 1) + "]";
      case 4:
        return "[" + expression(depth - 1) + pick({" AND ", " OR ", " XOR "}) +
               expression(depth - 1) + "]";
      case 5:
        return "[" + expression(depth - 1) + " mod " + expression(depth - 1) + "]";
      case 6:
        return "[" + expression(depth - 1) + "] / [" + std::to_string(1 + below(7)) + "]";
      case 7:
        return std::to_string(1 + below(3)) + "**" + std::to_string(below(4));
      default:
        return expression(depth - 1) + pick({" + ", " - ", " * "}) + expression(depth - 1);
    }
  }
  std::string axis_words(int range) {
    std::string words;
    for (const char axis : {'X', 'Y', 'Z'})
      if (one_in(2)) words += std::string(" ") + axis + number(-range, range);
    if (one_in(6)) words += pick({" A", " B", " C"}) + decimal(-90, 90);
    if (words.empty()) words = " X" + number(-range, range);
    return words;
  }
  std::string offset_words() {
    std::string words;
    for (const char axis : {'X', 'Y', 'Z'})
      if (one_in(2)) words += std::string(" ") + axis + decimal(-20, 20);
    if (one_in(8)) words += " A" + decimal(-20, 20);
    return words.empty() ? " X1" : words;
  }
  std::string rotation() {
    return rotates_ && !has_g92_ && one_in(2) ? " R" + pick({"30", "90", "-45", "0", "12.5"}) : "";
  }
  /// The stand-in of the reference for a tool changer takes the point of the last move for the
  /// current one and forgets rotation and length offset (docs/peer.md), so a program has tool
  /// changes or rotation, and a move before the change.
  void change_tool(int number) {
    if (rotates_) return add("T" + std::to_string(number));
    add("G49");
    add("G0 Z5");
    add("T" + std::to_string(number) + " M6");
    add("M3");
    has_tool_ = true;
  }
  /// The stand-in takes tool 1 for loaded as long as none is, so tool 1 is left alone then.
  std::string table_tool() { return std::to_string((has_tool_ ? 1 : 2) + below(2)); }
  std::string feed() { return inverse_time_ ? " F" + std::to_string(1 + below(9)) : ""; }

  // ---- families
  void line_move() {
    std::string line = pick({"G0", "G1", "G1", "G00", "g 1", "G01"}) + axis_words(30) + feed();
    if (one_in(12)) line = "G53 " + line;
    if (one_in(8)) line += " F" + std::to_string(10 + below(300));
    if (one_in(15)) line += " (a comment)";
    if (one_in(20))
      line +=
          " G" + (changes_unit_ ? pick({"90", "91", "20", "21", "17"}) : pick({"90", "91", "17"}));
    if (one_in(12)) line += " M" + pick({"3", "4", "7", "8", "9"});
    add(line);
  }

  void arc() {
    const std::string turn = pick({"G2", "G3", "G2", "G3", "G02"});
    const std::string extra = (one_in(6) ? " P" + std::to_string(1 + below(3)) : "") +
                              (one_in(4) ? third_axis() : "") + feed();
    switch (below(12) == 0 ? 5 : below(5)) {
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
            pick({"12", "-12", "9.5", "20", "5", "-7"}) + extra);
        add("G90");
        break;
      case 4:  // absolute centre
        add("G90.1 " + turn + centre(decimal(-20, 20), decimal(-20, 20)) + extra);
        add("G91.1");
        break;
      default:  // anything
        add(turn + axis_words(20) + pick({" I5", " J3", " I4 J2", " K3", " R15", " I1 R3"}) +
            extra);
    }
  }
  std::string third_axis() {
    return (plane_ == 0 ? " Z" : plane_ == 1 ? " Y" : " X") + decimal(-10, 10);
  }
  std::string ends(const std::string& a, const std::string& b) {
    static constexpr const char* names[3][2] = {{" X", " Y"}, {" X", " Z"}, {" Y", " Z"}};
    return names[plane_][0] + a + names[plane_][1] + b;
  }
  std::string centre(const std::string& a, const std::string& b) {
    static constexpr const char* names[3][2] = {{" I", " J"}, {" I", " K"}, {" J", " K"}};
    return names[plane_][0] + a + names[plane_][1] + b;
  }

  void modal() {
    switch (below(7)) {
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
        add("G90");
        break;
      case 3:
        add(pick({"G61", "G61.1", "G64", "G64 P0.1", "G64 P0.05 Q0.02"}));
        break;
      case 4:
        add(pick({"G98", "G99"}));
        break;
      case 5:
        add("F" + std::to_string(10 + below(200)));
        break;
      default:
        add(pick({"G80", "G0", "G1", "G90 G17 G94 F100", "G40 G49 G80"}));
        if (text_.ends_with("F100\n")) plane_ = 0, inverse_time_ = false;
    }
  }

  void feed_mode() {
    inverse_time_ = one_in(2);
    if (inverse_time_) {
      add("G93");
      add("G1" + axis_words(20) + feed());
      add("G2 " + centre("3", "4") + feed());
      inverse_time_ = false;
      add("G94 F" + std::to_string(10 + below(200)));
    } else {
      add("G95 F0." + std::to_string(1 + below(9)));
      add("G1" + axis_words(20));
      add("G94 F" + std::to_string(10 + below(200)));
    }
  }

  void offset() {
    switch (below(10)) {
      case 0:
        add("G10 L2 P" + std::to_string(below(4)) + offset_words() + rotation());
        break;
      case 1:
        add("G10 L20 P" + std::to_string(below(4)) + offset_words());
        break;
      case 2:
        add(pick({"G54", "G55", "G56", "G59.3", "G54"}));
        break;
      case 3:
        has_g92_ = true;  // the reference misplaces the point when the rotation changes then
        add("G92" + offset_words());
        break;
      case 4:
        has_g92_ = true;
        add("G52" + offset_words());
        break;
      case 5:
        add(pick({"G92.1", "G92.2", "G92.3"}));
        break;
      case 6:
        add("(DEBUG,#5221 #5222 #5223 #5230 #5241 #5250 #5211 #5212 #5213 #5210 #5220)");
        break;
      case 7:
        // Of #5211 the reference knows at G92.3 only, but not for its idea of the current point.
        add("#" + pick({"5221", "5222", "5223", "5241"}) + "=" + decimal(-5, 5));
        if (one_in(2)) add(pick({"G54", "G55"}));
        break;
      default:
        add("G0" + axis_words(20));
        add("(DEBUG,#5420 #5421 #5422 #<_x> #<_y> #<_z> #<_abs_x> #<_abs_y> #<_abs_z>)");
    }
  }

  void tool_offset() {
    // The reference does not convert the length offset in force at G20 and G21.
    if (changes_unit_) return offset();
    switch (below(10)) {
      case 0:
        add("G43 H" + std::to_string(1 + below(4)));
        break;
      case 1: {
        // Of an offset of A it knows nothing in G28 and G30.
        const std::string words = offset_words();
        add("G43.1" + words.substr(0, words.find(" A")));
        break;
      }
      case 2:
        add("G49");
        break;
      case 3:
        add("G43");
        break;
      case 4:
        add("G10 L1 P" + table_tool() + offset_words() + (one_in(3) ? " R" + decimal(1, 5) : ""));
        break;
      case 5:
        add("G10 L" + pick({"10", "11"}) + " P" + table_tool() + offset_words());
        break;
      case 6:
        change_tool(1 + below(3));
        add("(DEBUG,#5400 #5401 #5402 #5403 #5410 #5413)");
        break;
      case 7:
        add("G43.2 H" + std::to_string(1 + below(3)));
        break;
      case 8:
        add("G43 H2");
        break;
      default:
        add("G0" + axis_words(20));
    }
  }

  void cycle() {
    if (one_in(2)) add("G0" + axis_words(20));
    std::string code = pick({"G81", "G81", "G82", "G83", "G73", "G85", "G86", "G89", "G84", "G74"});
    // Outside of G17 the reference prints the axes of a tapping feed in another order.
    if (plane_ != 0 && (code == "G84" || code == "G74")) code = "G81";
    if (code == "G74") add("M4");
    static constexpr const char* depth[] = {" Z", " Y", " X"};
    const bool incremental = one_in(4);
    std::string line =
        std::string(incremental ? "G91 " : "") + (one_in(3) ? pick({"G98 ", "G99 "}) : "") + code;
    line += ends(decimal(-20, 20), decimal(-20, 20));
    line += depth[plane_] + (incremental ? decimal(-12, -1) : decimal(-12, 0));
    line += " R" + decimal(incremental ? -2 : 1, 12);
    if (code == "G82" || code == "G89" || code == "G86" || (code == "G84" && one_in(2)))
      line += " P0." + std::to_string(1 + below(9));
    if (code == "G83" || code == "G73") line += peck();
    // The reference refuses L with G74.
    if (one_in(4) && code != "G74") line += " L" + std::to_string(1 + below(3));
    add(line);
    for (int more = below(3); more > 0; --more)
      add(ends(decimal(-20, 20), decimal(-20, 20)).substr(1) +
          (one_in(4) ? depth[plane_] + decimal(-12, -1) : std::string()) +
          (one_in(5) && code != "G74" ? " L2" : "") + (one_in(5) ? " R" + decimal(1, 9) : ""));
    if (one_in(5)) add(pick({"G81", "G82 X1", "G83 Y2", "G98", "G99"}));
    if (incremental) add("G90");
    if (!one_in(4)) add("G80");
  }

  /// Never a whole part of the depth, where rounding decides on the number of pecks.
  std::string peck() {
    return " Q" + std::to_string(1 + below(5)) + "." + std::to_string(10 + below(90)) + "3";
  }

  void parameter() {
    switch (below(6)) {
      case 0:
        add("#" + std::to_string(1 + below(6)) + "=[" + expression(3) + "]");
        break;
      case 1:
        add("#" + std::to_string(1 + below(3)) + "=" + decimal(-9, 9) + " #" +
            std::to_string(1 + below(3)) + "=[#1+1] G0 X#1");
        break;
      case 2:
        add("#<" + pick({"a", "B c", "_global"}) + ">=[" + expression(2) + "]");
        break;
      case 3:
        add("(DEBUG,#1 #2 #3 #4 #5 #6 #<a> #<bc> #<_global>)");
        break;
      case 4:
        add("#[" + std::to_string(1 + below(4)) + "]=##" + std::to_string(1 + below(3)));
        break;
      default:
        add("(DEBUG,#<_metric> #<_plane> #<_feed> #<_rpm> #<_motion_mode> #<_coord_system> "
            "#<_spindle_on> #<_spindle_cw> #<_mist> #<_flood> #<_current_tool> #<_tool_offset> "
            "#<_absolute> #<_inverse_time> #<_units_per_minute> #<_retract_old_z>)");
    }
  }

  std::string label() { return "o" + std::to_string(100 + ++labels_); }

  void flow() {
    const std::string o = label();
    switch (below(6)) {
      case 0:
        add(o + " if [" + expression(2) + "]");
        add("G0" + axis_words(10));
        if (one_in(2)) {
          // The reference evaluates it even when a branch was taken, so it has a value.
          add(o + " elseif [#1 GT " + decimal(-3, 3) + "]");
          add("G0" + axis_words(10));
        }
        if (one_in(2)) {
          add(o + " else");
          add("G0" + axis_words(10));
        }
        add(o + " endif");
        break;
      case 1:
        add(o + " repeat [" + pick({"2", "1.4", "2.6", "0", "#1"}) + "]");
        add("G91 G0" + axis_words(3));
        add("G90");
        add(o + " endrepeat");
        break;
      case 2: {
        add("#10=0");
        add(o + " while [#10 LT " + std::to_string(below(4)) + "]");
        add("#10=[#10+1]");
        if (one_in(2)) {
          const std::string inner = label();
          add(inner + " if [#10 EQ 2]");
          // After a break the reference runs every do loop once only.
          const bool breaks = !has_do_ && one_in(2);
          has_break_ = has_break_ || breaks;
          add(o + (breaks ? " break" : " continue"));
          add(inner + " endif");
        }
        add("G0 X#10");
        add(o + " endwhile");
        break;
      }
      case 3:
        if (has_break_) return parameter();
        has_do_ = true;
        add("#10=0");
        add(o + " do");
        add("#10=[#10+1]");
        add("G0 Y#10");
        add(o + " while [#10 LT " + std::to_string(below(4)) + "]");
        break;
      default: {
        const bool before = one_in(2);
        std::string body = o + " sub\n  G0 X#1 Y[#2*2] Z#3\n  #1=[#1+1] #31=[#31+1]\n";
        if (one_in(2)) body += "  (DEBUG,in #1 #2 #3 #30 #31 #<_call_level>)\n";
        if (one_in(3)) body += "  " + o + " return [#1*3]\n";
        body += o + " endsub" + (one_in(2) ? " [#1+#31]" : "") + "\n";
        if (before)
          text_ += body;
        else
          subs_ += body;
        add(o + " call [" + expression(1) + "] [" + decimal(-5, 5) + "]");
        add("(DEBUG,#1 #2 #31 #<_value> #<_value_returned>)");
      }
    }
  }

  void polar() {
    if (plane_ != 0) {
      plane_ = 0;
      add("G17");
    }
    add("G0 X" + decimal(1, 20) + " Y" + decimal(1, 20));
    add("G1 @" + decimal(1, 20) + " ^" + decimal(-180, 180) + feed());
    if (one_in(2)) add("G1 ^" + decimal(-180, 180) + (one_in(3) ? " Z1" : ""));
    if (one_in(2)) add("G0 @" + decimal(1, 20));
    if (one_in(3)) {
      add("G91 G1 @" + decimal(1, 5) + " ^" + decimal(-90, 90));
      add("G90");
    }
  }

  void machine_code() {
    add(pick({"M3 S100",
              "M4",
              "M5",
              "M3",
              "S200",
              "M7",
              "M8",
              "M9",
              "M48",
              "M49",
              "M50 P0",
              "M51 P1",
              "M52 P1",
              "M53 P0",
              "M62 P1",
              "M63 P2",
              "M64 P1",
              "M65 P0",
              "M67 E1 Q2.5",
              "M68 E0 Q-1",
              "G4 P0.25",
              "G4 P[1/4]",
              "M19 R45",
              "G96 D1000 S100",
              "G97 S200",
              "M0",
              "M1",
              "M60",
              "(a plain comment)",
              "(MSG, hello)",
              "(DEBUG, %d#1 %.3f#2)",
              "M3",
              "M3 M8 S[100+#1]",
              "S0",
              "G61 M8 (x)",
              "M66 P1 L0"}));
    if (one_in(3)) add("M3 S300");
  }

  void compensated() {
    if (plane_ != 0) {
      plane_ = 0;
      add("G17");
    }
    const std::string side = pick({"G41", "G42"});
    add("G40 G49 G80 G90 G94 F100");
    add("G0 X-40 Y-10");
    add(one_in(3) ? side + " D" + std::to_string(1 + below(2))
                  : side + ".1 D" + pick({"4", "6", "-4", "0", "1"}));
    // A walk that turns by at most a right angle: near a reversal the two judge gouges differently.
    static constexpr int ways[8][2] = {{10, 0},  {7, 7},   {0, 10},  {-7, 7},
                                       {-10, 0}, {-7, -7}, {0, -10}, {7, -7}};
    int x = -10, y = 5 * below(3), way = below(2);
    const auto point = [&] { return "X" + std::to_string(x) + " Y" + std::to_string(y); };
    add("G1 " + point());
    for (int i = 4 + below(5); i > 0; --i) {
      way = (way + 6 + below(5)) % 8;
      const int length = 2 + below(3);
      x += ways[way][0] * length;
      y += ways[way][1] * length;
      if (one_in(4))
        add(pick({"G2 ", "G3 "}) + point() + " R" + pick({"40", "60", "35"}));
      else
        add(pick({"G1 ", "G1 ", "G1 ", "G0 "}) + point() +
            (one_in(5) ? " Z" + decimal(-5, 5) : ""));
      if (one_in(8)) add("G1 Z" + decimal(-5, 5));
      if (one_in(12)) add(pick({"M8", "G4 P1", "F80", "(in between)", "#1=#<_x>"}));
    }
    add("G40");
    add("G1 X-40 Y-30");
  }

  void home() {
    switch (below(5)) {
      case 0:
        add("G28" + (one_in(2) ? axis_words(10) : ""));
        break;
      case 1:
        add("G30" + (one_in(2) ? axis_words(10) : ""));
        break;
      case 2:
        add("G28.1");
        break;
      case 3:
        add("G30.1");
        break;
      default:
        add("G53 G" + pick({"0", "1"}) + axis_words(20) + feed());
    }
  }

  void lathe() {
    switch (below(5)) {
      case 0:
        add("G7");
        add("G0" + axis_words(20));
        add("G91 G0 X2");
        add("G90");
        if (plane_ != 2) add("G2 " + centre("2", "3"));
        add("G8");
        break;
      case 1:
        add("G33 Z" + decimal(-20, 0) + " K" + decimal(1, 3));
        break;
      case 2:
        add("G33.1 Z" + decimal(-20, 0) + " K" + decimal(1, 3) + (one_in(3) ? " I2" : ""));
        break;
      case 3:  // depths that no pass meets exactly, where rounding decides on their number
        add("G0 X12 Z3");
        add("G76 P" + decimal(1, 2) + " Z" + decimal(-30, -10) + " I" + pick({"-2", "-1", "3"}) +
            " J0." + std::to_string(2 + below(5)) + " K" + pick({"0.93", "1.27", "1.01"}) +
            (one_in(2) ? " R" + pick({"1", "1.5", "2"}) : "") +
            (one_in(2) ? " Q" + pick({"29.5", "30", "0"}) : "") +
            (one_in(2) ? " H" + std::to_string(below(3)) : "") +
            (one_in(3) ? " E" + pick({"1", "2"}) + " L" + std::to_string(below(4)) : ""));
        break;
      default:
        add("G96 D2000 S150");
        add("G97 S300");
    }
  }

  void spline() {
    if (plane_ != 0) {
      plane_ = 0;
      add("G17");
    }
    switch (below(3)) {
      case 0:
        add("G5 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " I1 J2 P-1 Q2");
        if (one_in(2)) add("G5 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " P-1 Q2");
        break;
      case 1:
        add("G5.1 X" + decimal(1, 9) + " Y" + decimal(1, 9) + " I1 J2");
        break;
      default:
        add("G5.2 X1 Y1 P1 L3");
        add("X2 Y3 P2");
        add("X3 Y1 P1");
        add("X5 Y1 P1");
        add("G5.3");
    }
    add("G0 X" + decimal(1, 9));
  }

  void stack() {
    add(pick({"M70", "M73"}));
    add(changes_unit_ && one_in(5)
            ? "G20"
            : pick({"G91", "G55", "F33", "G98", "G90.1", "G61", "S50", "M5", "G7"}));
    if (!one_in(3)) add("M72");
    add("G90 G54 G21 G8 G91.1 G94 F100");
    add("M3 S100");
  }

  /// Lines that must be refused, more or less. They end the comparison, so they are rare.
  void hostile() {
    if (!one_in(6)) return line_move();
    add(pick({"G1 X",
              "G0 X1 X2",
              "G2 X1 Y1",
              "G2 X50 Y50 R2",
              "G0 G1 X1",
              "M3 M4",
              "X[1/0]",
              "#5400=1",
              "#5700=1",
              "G0 X#<nobody>",
              "G0 X[1+",
              "G0 X1 P2",
              "G10 L2 P99 X1",
              "G10 X1",
              "T77",
              "G43 H55",
              "G81 X1 Z-1",
              "G83 X1 Z-1 R1",
              "G81 X1 Z5 R1",
              "G4",
              "G4 P-1",
              "G53 X1 G2",
              "G33 Z-1",
              "G5 X1 Y1",
              "G77",
              "M20",
              "G0 U1",
              "G41.1",
              "G92",
              "G52",
              "G38.2",
              "X1e3",
              "G0 (a (b) c)",
              "(unclosed",
              "M62",
              "G64 P-1",
              "F-1",
              "S-1",
              "G10 L20 P1 X1 R1",
              "G10 L1 P1",
              "G1 @5 X1",
              "o1 endif",
              "o5 call",
              "G61 G64",
              "G2 I0 J0",
              "G3 X1 Y1 I100",
              "M66 P1 L3",
              "M72",
              "G93 G81 X1 Z-1 R1 F1",
              "G0 X1 R1",
              "G90.1 G2 I1",
              "G19 G2 I1 J1",
              "G20.5",
              "G0 X.",
              "G0 X1.2.3",
              "N5 N6",
              "G0 X#0",
              "G1 X1 F0",
              "M3 M7 M48 M61 M0",
              "G76 X1",
              "G0 X1 $",
              "g",
              "x",
              "#1",
              "#1=",
              "[1]",
              "G17.2",
              "G0 Xsqrt[-1]",
              "G0 Xacos[2]",
              "G5.1 X1 Y1 I1",
              "G30.2"}));
  }

  std::mt19937 random_;
  std::string text_, subs_;
  int line_ = 0;
  int labels_ = 0;
  bool rotates_ = false;
  bool changes_unit_ = false;
  bool has_tool_ = false;
  bool has_g92_ = false;
  bool has_break_ = false, has_do_ = false;
  int plane_ = 0;  // 0 XY, 1 ZX, 2 YZ
  bool inverse_time_ = false;
};

}  // namespace

std::string generate_program(std::uint32_t seed) { return Generator(seed).program(); }

}  // namespace aircut::test
