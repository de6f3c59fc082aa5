// Dovetail fixture on the turntable (z = 0 its face): riser with a top that grips the raw part from below.
include <params.scad>


disc(58, 14, 2, $fn = 72);
translate([0, 0, 13]) turned([[0, 0], [40, 0], [30, 10], [26, 40], [0, 40]], $fn = 64);
plate_at([-28, -28, 52], [28, 28, 70], 4, 2);
for (k = [0:3]) rotate([0, 0, 45 + k * 90]) translate([47, 0, 13]) socket_screw(8);

