#include "peer/program_maker.h"

namespace aircut::test {

void ProgramMaker::cycle() {
  if (inverse_time_) return line_move();
  if (one_in(2)) add("G0" + axis_words(20));
  // Rounding by G20 and G21 may leave the level a hair beside R.
  if (changes_unit_) add("G0" + third_axis());
  std::string code = pick({"G81", "G81", "G82", "G83", "G83", "G73", "G73", "G85", "G86", "G87",
                           "G88", "G89", "G84", "G74"});
  // Outside of G17 the reference moves the wrong axes.
  if (plane_ != 0 && (code == "G84" || code == "G74")) code = "G85";
  if (code == "G74") add("M4");
  if (code == "G84" || code == "G86") add("M3");
  if (code == "G87" || code == "G88") add(pick({"M3", "M4"}));
  static constexpr const char* depth[] = {" Z", " Y", " X"};
  const bool incremental = one_in(4);
  std::string line =
      std::string(incremental ? "G91 " : "") + (one_in(3) ? pick({"G98 ", "G99 "}) : "") + code;
  line += ends(decimal(-20, 20), decimal(-20, 20));
  line += depth[plane_] + (incremental ? decimal(-12, -1) : decimal(-12, 0));
  line += " R" + decimal(incremental ? -2 : 1, 12);
  if (code == "G87") line += " I" + decimal(-3, 3) + " J" + decimal(-3, 3) + " K" + decimal(-3, 3);
  if (code == "G82" || code == "G89" || code == "G86" || code == "G88" ||
      (code == "G84" && one_in(2)))
    line += " P0." + std::to_string(1 + below(9));
  if (code == "G83" || code == "G73") line += peck();
  if (one_in(4) && code != "G74") line += " L" + std::to_string(1 + below(3));
  if (one_in(10)) line += " M8 F" + std::to_string(20 + below(50));
  add(line);
  for (int more = below(4); more > 0; --more) {
    if (one_in(12) && changes_unit_) add("G20");
    add(ends(decimal(-20, 20), decimal(-20, 20)).substr(1) +
        (one_in(4) ? depth[plane_] + decimal(-12, -1) : std::string()) +
        (one_in(5) && code != "G74" ? " L2" : "") + (one_in(5) ? " R" + decimal(1, 9) : "") +
        (one_in(8) && (code == "G83" || code == "G73") ? peck() : ""));
    if (one_in(8)) add(pick({"G98", "G99", "M8", "(between holes)", "F77", "G91", "G90"}));
  }
  if (one_in(5))
    add(pick({"G81", "G82 X1", "G83 Y2", "G98", "G99", "G81 X1 Z-3", "G85 Y5 R2 Z-1"}));
  add("G90");
  if (!one_in(4)) add("G80");
}

std::string ProgramMaker::peck() {
  return " Q" + (one_in(3) ? pick({"1", "2", "0.5", "0.3"}) : decimal(1, 5));
}

}  // namespace aircut::test
