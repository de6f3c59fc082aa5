// Head casting: carriage on the Z rails, arm, spindle housing. Gauge face at (0, 0, nose_z).
include <params.scad>

z0 = nose_z;
difference() {
  union() {
    // arm, as seen from the side
    intersection() {
      translate([-125, 0, 0]) rotate([90, 0, 90]) linear_extrude(height = 250) soft(14) polygon([
        [-119, z0 + 62], [95, z0 + 62], [150, z0 + 110], [330, z0 + 170], [330, z0 + 90], [400, z0 + 90],
        [400, z0 + 560], [-119, z0 + 560]]);
      // rounded towards the operator
      hull() {
        translate([0, 0, z0]) cylinder(r = 118, h = 700, $fn = 64);
        block_at([-125, 150, z0], [125, 440, z0 + 700], 2);
      }
    }
    // carriage
    difference() {
      block_at([-225, 360, z0 + 62], [225, column_y - 32, z0 + 560], 8);
      for (s = [0, 1]) mirror([s, 0, 0]) translate([0, 0, z0 + 62])
        block_at([150, 340, 60], [215, 385, 438], 8);
    }
    // ribs between the arm and the carriage
    for (s = [-1, 1]) hull() {
      block_at([s * 128 - 9, 300, z0 + 190], [s * 128 + 9, 380, z0 + 540], 3);
      block_at([s * 200 - 9, 365, z0 + 190], [s * 200 + 9, 390, z0 + 540], 3);
    }
    // spindle housing below the arm
    translate([0, 0, z0 + 20]) turned([[0, 0], [78, 0], [86, 8], [86, 30], [96, 44], [100, 46], [100, 70], [0, 70]], $fn = 64);
  }
  // bore of the spindle cartridge
  translate([0, 0, z0 - 1]) cylinder(r = 62, h = 560, $fn = 64);
  // side windows of the arm
  for (s = [0, 1]) mirror([s, 0, 0]) translate([109, 0, 0]) rotate([90, 0, 90]) linear_extrude(height = 30) soft(12)
    polygon([[110, z0 + 200], [290, z0 + 240], [290, z0 + 500], [150, z0 + 500], [110, z0 + 470]]);
}
