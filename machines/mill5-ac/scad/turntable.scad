// Turntable: face with eight radial T-slots, a centre bore, a scale on its rim.
include <params.scad>

difference() {
  union() {
    translate([0, 0, c_face - 34]) disc(c_radius, 34, 2, $fn = 96);
    translate([0, 0, c_face - 39]) disc(86, 8, 1, $fn = 72);
  }
  for (k = [0:7]) rotate([0, 0, k * 45]) t_slot(36, c_radius + 5, 0, c_face, 10, 18, 9, 8);
  translate([0, 0, c_face - 20]) cylinder(r = 15, h = 40, $fn = 48);
  for (k = [0:35]) rotate([0, 0, k * 10]) translate([c_radius, 0, c_face - 12]) cube([2, 1, k % 9 == 0 ? 16 : 8], center = true);
}
