// Housing of the turret.
include <params.scad>

difference() {
  hull() {
    translate([0, 84, gauge_z - 150]) disc_y(110, 250, 10, $fn = 40);
    block_at([-150, 100, 540], [150, 400, 580], 8);
  }
  for (s = [-1, 1]) translate([s * 140 - 30, 170, 640]) cube([60, 120, 80]);
}
translate([0, 330, gauge_z - 150]) rotate([-90, 0, 0]) motor(100, 60);
