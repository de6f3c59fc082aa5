// Second headstock on its slide.
include <params.scad>

hull() {
  translate([540, 0, 0]) disc_x(80, 190, 8, $fn = 48);
  block_at([560, -78, top + 40], [730, 78, top + 60], 5);
}
block_at([600, -86, top + 8], [726, 86, top + 50], 5);
translate([690, 0, 74]) motor(80, 130);
