// X rails, X ball screw, bearing blocks and X motor: all carried by the saddle.
include <params.scad>

for (s = [-1, 1]) translate([-440, s * x_rail_y, x_rail_z + 2 - eps]) rail_x(880, 30, 25);
translate([-430, 0, x_rail_z + 6]) disc_x(13, 860, 1);
for (x = [-440, 396]) block_at([x, -42, x_rail_z - 4], [x + 44, 42, x_rail_z + 34], 4);
translate([456 - eps, 0, x_rail_z - 14]) rotate([0, 90, 0]) servo(96, 150);
block_at([430, -56, x_rail_z - 66], [457, 56, x_rail_z + 36], 4);
