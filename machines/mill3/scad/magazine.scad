// Tool magazine: a drum of sixteen pots on an arm of the column, left of the head.
include <params.scad>

cx = -440; cy = 90; cz = 1560;
// drum with pots; pots hang down and take the tool's taper
translate([cx, cy, cz]) {
  disc(150, 46, 6, $fn = 64);
  translate([0, 0, 45]) disc(70, 60, 8);
  translate([0, 0, 104]) servo(80, 90);
  for (i = [0:15]) rotate([0, 0, i * 22.5]) translate([172, 0, -6]) {
    difference() {
      disc(27, 58, 3, $fn = 24);
      translate([0, 0, -1]) cylinder(r1 = 18, r2 = 11, h = 46, $fn = 20);
    }
    block_at([-34, -12, 14], [-20, 12, 44], 2);
  }
}
// arm
block_at([cx - 40, cy - 40, cz + 60], [cx + 40, 560, cz + 100], 8);
block_at([cx - 40, 500, cz + 40], [-196, 580, cz + 120], 8);
translate([cx, cy, cz + 58]) disc(58, 46, 4);
