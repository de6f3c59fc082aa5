// Splash ring around the table.
include <params.scad>

difference() {
  translate([0, 0, -110]) cylinder(r = 520, h = 400, $fn = 72);
  translate([0, 0, -111]) cylinder(r = 514, h = 402, $fn = 72);
  translate([-600, 200, -200]) cube([1200, 600, 600]);
}
