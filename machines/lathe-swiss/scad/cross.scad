// Z2 slide.
include <params.scad>

block_at([192, -330, top + 5], [290, -60, top + 30], 4);
for (x = [206, 262]) translate([x + 8, -322, top + 29]) rotate([0, 0, 90]) rail_x(258, 18, 14, 90);
translate([240, -328, top + 17]) rotate([90, 0, 0]) motor(60, 110);
