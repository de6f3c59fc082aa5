// Guides 1 (front, z = -d) and 2 (rear, z = +d): a pair of rails each, ball screw, motor.
include <params.scad>

module guide() {  // on the face y = 0, pointing to -Y, centre at z = 0
  for (z = [-28, 28]) translate([x_mid - 350, 0, z]) rotate([90, 0, 0]) rail_x(700, 18, 14, 50);
  translate([x_mid - end_in - 2, -16, 0]) disc_x(7, 2 * end_in + 4, 1);
  for (s = [-1, 1]) block_at([x_mid + s * 338 - 14, -32, -17], [x_mid + s * 338 + 14, 1, 17], 3);
}
translate([0, -beam_out + eps, -d]) guide();
translate([0, beam_out - eps, d]) mirror([0, 1, 0]) guide();
// motors on the outer faces of the end plates
translate([x_mid + end_out - eps, -beam_out - 16, -d]) rotate([0, 90, 0]) servo(64, 84);
translate([x_mid - end_out + eps, beam_out + 16, d]) rotate([0, -90, 0]) servo(64, 84);
