// X slide on the beam, with the guides of the Z slide.
include <params.scad>

x = axis_x;
difference() {
  block_at([x - 210, 226, 1640], [x + 210, 312, 2330], 8);
  block_at([x - 70, 210, 1700], [x + 70, 260, 2280], 8);
}
for (s = [-1, 1], z = [1800, 2095]) block_at([x + s * 140 - 60, 300, z], [x + s * 140 + 60, 338, z + 50], 4);
for (s = [-1, 1]) translate([x + s * 150, 228, 1660]) rotate([0, -90, 90]) rail_x(640, 34, 28, 160);
translate([x, 262, 2325]) motor(110, 170);
