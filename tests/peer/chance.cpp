#include "peer/chance.h"

#include <cctype>

namespace aircut::test {

std::string Chance::decimal(int from, int to) {
  std::string sign;
  int value = from * 100 + below((to - from) * 100 + 1);
  if (one_in(3)) value = value / 100 * 100;
  if (value < 0) sign = "-", value = -value;
  std::string text = sign + std::to_string(value / 100);
  if (value % 100 != 0) text += "." + std::to_string(value % 100 / 10) + std::to_string(value % 10);
  return text;
}

std::string Chance::number(int from, int to) {
  switch (below(14)) {
    case 0:
      return "[" + decimal(from, to) + "]";
    case 1:
      return "[" + decimal(from, to) + " + #" + std::to_string(1 + below(4)) + " / 4]";
    case 2:
      return "#" + std::to_string(1 + below(4));
    case 3:
      return "[" + expression(2) + "]";
    case 4:
      return "-#" + std::to_string(1 + below(4));
    case 5:
      return pick({"abs", "sin", "fix", "-cos", "round"}) + "[" + decimal(from, to) + "]";
    case 6:
      return "+" + std::to_string(below(10)) + pick({".", ".0", ""});
    default:
      return decimal(from, to);
  }
}

std::string Chance::value() {
  switch (below(8)) {
    case 0:
      return "#" + std::to_string(1 + below(6));
    case 1:
      return "-" + std::to_string(1 + below(4));
    case 2:
      return "#[1+" + std::to_string(below(3)) + "]";
    case 3:
      // Not -0: whether a position is that depends on how it was worked out, and ATAN shows it.
      return pick(
          {"#<_metric>", "#<_feed>", "[#<_x>+0]", "#<_call_level>", "#<_global>", "#<_plane>"});
    case 4:
      return "exists[#<" + pick({"nobody", "_x", "_nobody"}) + ">]";
    default:
      return decimal(-5, 9);
  }
}

std::string Chance::expression(int depth) {
  if (depth == 0 || one_in(4)) return value();
  const auto inner = [&] { return expression(depth - 1); };
  switch (below(14)) {
    case 0:
      return pick({"sin", "cos", "abs", "fix", "FUP", "round", "Tan"}) + "[" + inner() + "]";
    case 1:
      return "sqrt[abs[" + inner() + "]]";
    case 2:
      return "atan[" + inner() + "]/[" + inner() + "]";
    case 3:
      return "[" + inner() + pick({" EQ ", " NE ", " LT ", " LE ", " GT ", " GE "}) + inner() + "]";
    case 4:
      return "[" + inner() + pick({" AND ", " OR ", " XOR "}) + inner() + "]";
    case 5:
      return "[" + inner() + " mod " + pick({"3", "-2", "0.7", "[1+2]"}) + "]";
    case 6:
      return "[" + inner() + "] / [" + std::to_string(1 + below(7)) + "]";
    case 7:
      return pick({"2", "3", "1.5", "4", "-2"}) + "**" + pick({"0", "1", "2", "3", "-1"});
    case 8:
      return pick({"asin", "acos"}) + "[" + pick({"0.1", "-0.25", "0.75"}) + "]";
    case 9:
      return "ln[1+abs[" + inner() + "]]";
    case 10:
      return "exp[" + pick({"0", "1", "-1", "0.5", "2"}) + "]";
    case 11:  // all levels of precedence side by side
      return inner() + pick({" + ", "*", " - 2*", " eq ", " or "}) + value() +
             pick({" - ", " / 4 * ", " mod 7 - ", " gt ", " and "}) + value();
    default:
      return inner() + pick({" + ", " - ", " * "}) + inner();
  }
}

std::string Chance::spelled(const std::string& line) {
  if (!one_in(8) || line.find_first_of("(;%<") != std::string::npos) return line;
  const bool lower = one_in(2);
  std::string out;
  for (const char c : line) {
    if (one_in(12)) out += one_in(4) ? '\t' : ' ';
    out += lower ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
  }
  return out + (one_in(3) ? " ; text behind" : "");
}

}  // namespace aircut::test
