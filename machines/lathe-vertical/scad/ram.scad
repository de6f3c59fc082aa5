// Ram: slide of Z. The gauge face is its lower end.
include <params.scad>

x = gauge_x;
difference() {
  union() {
    block_at([x - 85, -85, gauge_z + 72], [x + 85, 85, 2330], 8);
    translate([x, 0, gauge_z]) turned([[0, 0], [42, 0], [46, 4], [46, 20], [66, 24], [66, 74], [0, 74]], $fn = 48);
  }
  block_at([x - 30, -95, gauge_z + 200], [x + 30, -80, 2250], 2);
}
translate([x, 0, 2325]) motor(110, 160);
