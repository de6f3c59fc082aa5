// Turntable with T-slots.
include <params.scad>

difference() {
  translate([0, 0, 534]) turned([[0, 0], [440, 0], [480, 20], [500, 26], [500, 64], [498, 66], [0, 66]], $fn = 96);
  for (k = [0:7]) rotate([0, 0, k * 45]) translate([110, -11, 578]) cube([420, 22, 40]);
  translate([0, 0, 560]) cylinder(r = 60, h = 60, $fn = 48);
}
