// Cross rail with the guides of the saddle.
include <params.scad>

difference() {
  block_at([-330, 200, 1150], [1250, 445, 1490], 12);
  for (i = [0:5]) block_at([-290 + i * 255, 440, 1190], [-70 + i * 255, 480, 1450], 14);
}
for (z = [1190, 1450]) translate([-320, 201, z]) rotate([90, 0, 0]) rail_x(1560, 40, 30, 260);
translate([-320, 186, 1320]) rotate([0, 90, 0]) cylinder(r = 16, h = 1560, $fn = 20);
translate([1245, 205, 1320]) rotate([0, 90, 0]) motor(120, 190);
block_at([1225, 120, 1260], [1250, 300, 1380], 4);
