// Sliding headstock.
include <params.scad>

difference() {
  union() {
    hull() {
      translate([-600, 0, 0]) disc_x(88, 260, 8, $fn = 48);
      block_at([-600, -85, top + 40], [-340, 85, top + 70], 5);
    }
    block_at([-620, -100, top + 8], [-330, 100, top + 50], 5);
  }
  translate([-601, 0, 0]) rotate([0, 90, 0]) cylinder(r = 20, h = 40, $fn = 28);
}
translate([-470, 0, 80]) motor(90, 140);
