// Rails: headstock, gang slide, front slide, second spindle.
include <params.scad>

for (y = [-60, 60]) translate([-660, y, top - 1]) rail_x(560, 24, 20, 140);
for (y = [-50, 50]) translate([340, y, top - 1]) rail_x(440, 24, 20, 140);
for (y = [-300, -90]) translate([90, y, top - 1]) rail_x(230, 22, 18, 100);
for (x = [118, 202]) translate([x + 8, 60, top - 1]) rotate([0, 0, 90]) rail_x(300, 22, 18, 100);
