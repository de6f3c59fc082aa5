// Gantry: two columns and the beam, which moves along Y.
include <params.scad>

for (s = [-1, 1]) difference() {
  union() {
    taper([s * 1560 - 150, -360, s * 1560 + 150, 700], 600, [s * 1560 - 130, 120, s * 1560 + 130, 680], 2460, 20);
    block_at([s * 1560 - 170, -420, 545], [s * 1560 + 170, 720, 640], 8);
  }
  for (z = [780, 1280]) block_at([s * 1560 - 200, 60, z], [s * 1560 + 200, 480, z + 360], 30);
}
block_at([-1720, 240, 2450], [1720, 690, 3060], 16);
for (z = [2530, 2980]) translate([-1680, 241, z]) rotate([90, 0, 0]) rail_x(3360, 50, 40, 420);
translate([-1690, 225, 2755]) rotate([0, 90, 0]) cylinder(r = 24, h = 3380, $fn = 24);
