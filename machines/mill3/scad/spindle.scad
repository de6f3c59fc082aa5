// Spindle cartridge with its nose. The gauge face is the plane z = nose_z; the taper is bored from
// there upwards (7/24, 31.75 at the face, the size of a 30 taper), so that holders fit into it.
include <params.scad>

$fn = 64;
difference() {
  translate([0, 0, nose_z]) turned([
    [0, 0], [30, 0], [32, 2], [32, 14], [40, 18], [58, 20], [60, 22], [60, 300], [40, 330], [0, 330]]);
  translate([0, 0, nose_z]) turned([[0, -1], [16.3, -1], [16.3, 0], [8.8, 52], [8.8, 80], [0, 80]]);
}
// drive keys
for (s = [0, 180]) rotate([0, 0, s]) block_at([19, -7.5, nose_z + 1 - 4], [30, 7.5, nose_z + 4], 0.8);
