// Y carriage: two end plates on the frame's walls, and between them the beams of both guides.
// The front beam is low (guide 1), the rear beam high (guide 2).
include <params.scad>

module bar(y, z) { // beam with a hollow front and back
  difference() {
    block_at([x_mid - end_in - 5, y - 20, z - 42], [x_mid + end_in + 5, y + 20, z + 42], 3);
    for (s = [-1]) for (i = [-3:3]) translate([x_mid + i * 100 - 40, y - s * 13, z - 26])
      rotate([-90 * s * -1, 0, 0]) mirror([0, s < 0 ? 1 : 0, 0]) linear_extrude(height = 20) soft(8) square([80, 52]);
  }
}
difference() {
  union() {
    bar(-90, -d);
    mirror([0, 1, 0]) bar(-90, d);
    for (s = [0, 1]) translate([x_mid, 0, 0]) mirror([s, 0, 0]) {
      // end plate
      translate([end_in, 0, 0]) rotate([90, 0, 90]) linear_extrude(height = end_out - end_in) soft(14) polygon([
        [-150, -128], [-50, -128], [10, -40], [150, 20], [150, 128], [175, 150], [175, 236], [-175, 236],
        [-175, 150], [-150, 100]]);
      // arm over the wall, with its trucks on the rail
      block_at([end_in + 2, -172, 176], [wall_out - 4, 172, 232], 6);
      for (y = [-125, 125]) block_at([505, y - 46, wall_top + 8], [575, y + 46, 178], 4);
      hull() {
        block_at([end_out - 2, -10, 60], [end_out + 2, 10, 180], 1);
        block_at([end_out - 2, -10, 170], [wall_in - 20, 10, 180], 1);
      }
      block_at([wall_in - 2, -40, wall_top + 6], [wall_in + 32, 40, 180], 4);  // nut housing
    }
    // bridge between the end plates, above the spindle
    block_at([x_mid - end_in - 5, 120, 178], [x_mid + end_in + 5, 172, 234], 6);
    block_at([x_mid - end_in - 5, -172, 190], [x_mid + end_in + 5, -136, 234], 6);
  }
  for (s = [-1, 1]) block_at([x_mid + s * 540 - 18, -300, wall_top - 5], [x_mid + s * 540 + 18, 300, wall_top + 29], 1);
  translate([x_mid, 0, 0]) for (s = [-1, 1]) translate([s * 510, -330, wall_top + 22])
    rotate([-90, 0, 0]) cylinder(r = 11.5, h = 660, $fn = 24);
}
