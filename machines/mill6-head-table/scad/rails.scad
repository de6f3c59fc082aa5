// Rails of the gantry.
include <params.scad>

for (x = [-1660, -1460, 1460, 1660]) translate([x, -1280, 499]) rotate([0, 0, 90]) rail_x(2560, 50, 40, 320);
