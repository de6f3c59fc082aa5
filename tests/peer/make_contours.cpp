// Contours with radius compensation: a walk along eight directions with straight lines and arcs.
#include <array>

#include "peer/program_maker.h"

namespace aircut::test {
namespace {

constexpr int ways[8][2] = {{10, 0},  {7, 7},   {0, 10},  {-7, 7},
                            {-10, 0}, {-7, -7}, {0, -10}, {7, -7}};

}  // namespace

// One element from (x, y). The way turns by at most a right angle: near a reversal the two judge
// gouges differently.
void ProgramMaker::contour_piece(int& x, int& y, int& way) {
  way = (way + 6 + below(5)) % 8;
  const int length = 1 + below(4);
  const int dx = ways[way][0] * length, dy = ways[way][1] * length;
  const std::string z = one_in(5) ? " Z" + decimal(-5, 5) : "";
  const auto point = [&] { return "X" + std::to_string(x) + " Y" + std::to_string(y); };
  switch (below(8)) {
    case 0:
      x += dx, y += dy;
      return add(pick({"G2 ", "G3 "}) + point() + " R" + pick({"40", "60", "35", "30"}) + z +
                 feed());
    case 1:  // a quarter from one axis' direction to the next
      if (way % 2 != 0) break;
      {
        const int r = 5 * length;
        const bool left = one_in(2);
        const int side = left ? 1 : -1;
        const int ax = ways[way][0] / 10, ay = ways[way][1] / 10;
        x += r * (ax - side * ay), y += r * (ay + side * ax);
        const std::string centre =
            " I" + std::to_string(-side * r * ay) + " J" + std::to_string(side * r * ax);
        way = (way + (left ? 2 : 6)) % 8;
        return add((left ? "G3 " : "G2 ") + point() + centre + z + feed());
      }
    case 2: {
      x += dx, y += dy;
      add("G91 G1 X" + std::to_string(dx) + " Y" + std::to_string(dy) + z + feed());
      return add("G90");
    }
    case 3:
      x += dx, y += dy;
      return add("G0 " + point());
    default:
      break;
  }
  x += dx, y += dy;
  add("G1 " + point() + z + feed());
}

void ProgramMaker::contour() {
  known_modes();
  add("G49");
  add("G0 X-40 Y-10");
  inverse_time_ = one_in(8);
  if (inverse_time_) add("G93");
  const std::string side = pick({"G41", "G42"});
  add(one_in(3) ? side + " D" + std::to_string(1 + below(2))
                : side + ".1 D" + pick({"4", "6", "-4", "0", "1", "10", "2.5"}));
  int x = -10, y = 5 * below(3), way = below(2);
  if (one_in(6))
    add(pick({"G2", "G3"}) + " X" + std::to_string(x) + " Y" + std::to_string(y) + " R" +
        pick({"30", "40", "25"}) + feed());
  else
    add(pick({"G1", "G1", "G0"}) + " X" + std::to_string(x) + " Y" + std::to_string(y) + feed());
  for (int i = 3 + below(7); i > 0; --i) {
    contour_piece(x, y, way);
    if (one_in(8)) add(pick({"G1 Z", "G0 Z", "G1 A"}) + decimal(-5, 5) + feed());
    if (one_in(12)) add(pick({"M8", "G4 P1", "F80", "(in between)", "#1=#<_x>", "S200", "G91.1"}));
    if (one_in(60))
      add(pick({"G55", "G0 G53 X0", "G81 X1 Z-1 R1", "M6", "G43 H1", "G17", "G28", "(DEBUG,#5420)",
                "#7=#5421", "G61", "G98", "M62 P1", "T2", "M70", "G92 X0", "G10 L2 P1 X1",
                "G10 L2 P3 X1", "M50 P1", "G7"}));
  }
  add("G40");
  if (one_in(6))
    add(pick({"(left)", "(DEBUG,#5420 #5421 #<_x> #<_abs_y>)", "G92 Y3", "G92.1", "G28.1"}));
  add(pick({"G1", "G0", "G53 G0"}) + " X-40 Y-30" + feed());
  if (one_in(4)) add("G92.1");
  if (inverse_time_) add("G94 F" + std::to_string(50 + below(200)));
  inverse_time_ = false;
  add("G21 G8");
}

// In ZX with the nose of a lathe tool.
void ProgramMaker::lathe_contour() {
  known_modes();
  add("G49");
  plane_ = 1;
  add("G18");
  add("G0 X40 Z20");
  const std::string nose = one_in(2) ? " L" + std::to_string(below(10)) : "";
  add(pick({"G41", "G42"}) + (one_in(3) ? " D3" : ".1 D" + pick({"1", "0.8", "2", "-1"}) + nose));
  int x = 5, z = 10;
  add(pick({"G1", "G0"}) + " X5 Z10");
  for (int i = 2 + below(5); i > 0; --i) {
    const int dx = below(6), dz = 3 + below(8);
    x += dx, z -= dz;
    const std::string point = " X" + std::to_string(x) + " Z" + std::to_string(z);
    if (one_in(4))
      add(pick({"G2", "G3"}) + point + " R" + pick({"20", "30", "15"}));
    else
      add("G1" + point);
    if (one_in(8)) add(pick({"(DEBUG,#5420 #5422)", "(DEBUG,#<_x> #<_z> #<_abs_x>)", "#7=#<_z>"}));
  }
  add("G40");
  add("G0 X40 Z20");
}

}  // namespace aircut::test
