// Rails of the X slide.
include <params.scad>

for (z = [1820, 2120]) translate([-1110, 346, z]) rotate([90, 0, 0]) rail_x(1500, 36, 28, 250);
translate([-1110, 332, 1970]) rotate([0, 90, 0]) cylinder(r = 16, h = 1480, $fn = 20);
translate([372, 332, 1970]) rotate([0, 90, 0]) motor(110, 170);
