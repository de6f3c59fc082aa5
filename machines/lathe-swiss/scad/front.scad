// Front and back tools on the X2 slide; a driven nose looks to either side.
include <params.scad>

block_at([196, -250, top + 40], [288, -90, top + 66], 4);
block_at([212, -170, top + 60], [268, -20, 70], 5);
block_at([214, -30, -34], [266, 20, 34], 4);
translate([210, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [20, 0], [22, 2], [22, 8], [0, 8]], $fn = 32);
translate([262, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [22, 0], [22, 6], [20, 8], [0, 8]], $fn = 32);
for (y = [-140, -96, -52], z = [-60, 0, 46]) { translate([204, y, z]) disc_x(11, 10, 1, $fn = 20); translate([264, y, z]) disc_x(11, 10, 1, $fn = 20); }
