// Spindle nose with its collet, turned by C1.
include <params.scad>

translate([-338, 0, 0]) rotate([0, 90, 0]) difference() {
  turned([[0, 0], [52, 0], [52, 20], [40, 28], [34, 44], [22, 48], [0, 48]], $fn = 48);
  for (k = [0:2]) rotate([0, 0, k * 120]) translate([0, -1, 30]) cube([60, 2, 30]);
}
