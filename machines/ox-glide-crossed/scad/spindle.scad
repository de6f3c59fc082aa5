// Motor spindle: nose at z = 0 (the gauge face), bored 7/24 with 22.2 at the face, the size of a
// 20 taper; flange, connector on top.
include <params.scad>

$fn = 48;
difference() {
  turned([[0, 0], [21, 0], [23, 2], [23, 12], [30, 14], [33.5, 18], [33.5, 138], [44, 140.5], [44, 210], [40, 216], [0, 216]]);
  turned([[0, -1], [11.5, -1], [11.5, 0], [6.4, 35], [6.4, 60], [0, 60]]);
}
translate([0, 0, 214]) disc(24, 18, 3, $fn = 32);
translate([14, -9, 190]) block([44, 18, 18], 2);
