// Support of the guide bush, fixed to the bed.
include <params.scad>

difference() {
  union() {
    hull() {
      translate([-58, 0, 0]) disc_x(62, 44, 4, $fn = 48);
      block_at([-58, -85, top], [-14, 85, top + 40], 4);
    }
    translate([-20, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [34, 0], [34, 10], [24, 20], [0, 20]], $fn = 48);
    block_at([-90, -110, top - 1], [-4, 110, top + 26], 4);
  }
  translate([-100, 0, 0]) rotate([0, 90, 0]) cylinder(r = 10.4, h = 120, $fn = 32);
}
