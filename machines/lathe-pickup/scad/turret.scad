// Turret, fixed to the base; the tool in its upper station looks up.
include <params.scad>

translate([0, -52, gauge_z - 150]) disc_y(100, 104, 6, $fn = 48);
translate([0, 48, gauge_z - 150]) disc_y(84, 40, 3, $fn = 48);
for (k = [0:7]) translate([0, 0, gauge_z - 150]) rotate([0, k * 45, 0]) {
  translate([-30, -34, 84]) cube([60, 68, 56]);
  if (k == 0) translate([0, 0, 132]) turned([[0, 0], [25, 0], [25, 15], [22, 18], [0, 18]], $fn = 32);
  else if (k % 2 == 1) translate([0, 0, 130]) cylinder(r = 17, h = 16, $fn = 20);
  else translate([-10, -10, 120]) cube([20, 20, 30]);
}
