// Gang of turning tools on the X1 slide.
include <params.scad>

block_at([112, 76, top + 6], [228, 250, top + 42], 5);
block_at([132, 20, top + 40], [200, 170, 70], 5);
block_at([134, -24, -34], [198, 30, 34], 4);
translate([130, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [20, 0], [22, 2], [22, 8], [0, 8]], $fn = 32);
for (y = [52, 96, 140], z = [-70, 0, 50]) translate([122, y - 8, z - 8]) cube([12, 16, 16]);
translate([170, 245, top + 24]) rotate([-90, 0, 0]) motor(70, 120);
