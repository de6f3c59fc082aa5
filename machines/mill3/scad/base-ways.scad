// Y rails, Y ball screw and Y motor on the base.
include <params.scad>

for (s = [-1, 1]) translate([s * y_rail_x, -435, way_z]) rotate([0, 0, 90]) rail_x(870, 34, 30);
// screw between its two bearing blocks, inside the trough
translate([0, -420, way_z - 30]) disc_y(15, 840, 1);
for (y = [-440, 400]) block_at([-45, y, way_z - 91], [45, y + 50, way_z + 14], 5);
translate([0, -440, way_z - 30]) rotate([90, 0, 0]) servo(110, 150);
