// Nose of the second spindle, turned by C2.
include <params.scad>

translate([400, 0, 0]) rotate([0, 90, 0]) difference() {
  turned([[0, 0], [16, 0], [24, 12], [24, 118], [46, 124], [46, 138], [0, 138]], $fn = 48);
  translate([0, 0, -1]) cylinder(r = 10.4, h = 40, $fn = 32);
}
