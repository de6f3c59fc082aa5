// Ring on the table. Only for pictures.
include <params.scad>

translate([0, 0, chuck_z + 15]) difference() {
  disc(150, work_z - chuck_z - 15, 1, $fn = 96);
  translate([0, 0, -1]) cylinder(r = 99, h = 100, $fn = 72);
}
