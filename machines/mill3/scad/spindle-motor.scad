// Spindle motor on the head, with cooling ribs, fan cowl and junction box.
include <params.scad>

z0 = nose_z + 556;
translate([0, 10, z0]) {
  disc(104, 26, 4, $fn = 48);
  difference() {
    translate([0, 0, 24]) disc(90, 200, 3, $fn = 48);
    for (i = [0:23]) rotate([0, 0, i * 15]) translate([84, -3, 40]) cube([20, 6, 150]);
  }
  translate([0, 0, 222]) disc(92, 46, 10, $fn = 48);
  translate([0, 85, 90]) block_at([-45, 0, 0], [45, 60, 90], 6);
}
// belt or gear case behind the motor, on the arm
block_at([-90, 130, z0 - 2], [90, 330, z0 + 60], 12);
