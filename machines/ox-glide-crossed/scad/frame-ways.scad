// Y rails on the walls, Y ball screw with its bearings and motor on the right wall.
include <params.scad>

for (s = [-1, 1]) translate([x_mid + s * 540, -328, wall_top]) rotate([0, 0, 90]) rail_x(656, 34, 28, 70);
translate([x_mid + 510, -318, wall_top + 22]) disc_y(10, 636, 1);
for (y = [-340, 312]) block_at([x_mid + 497, y, wall_top - 2], [x_mid + 522, y + 28, wall_top + 42], 3);
