// Column casting: tapered box with ribs and core windows, foot flange, head cap.
include <params.scad>

top = 2000;
difference() {
  union() {
    taper([-265, column_y + 5, 265, 850], way_z + 20 - eps, [-260, column_y + 4, 260, 845], 640, 16);
    taper([-250, column_y, 250, 830], 620, [-215, column_y, 215, 740], top - 60, 16);
    taper([-225, column_y, 225, 760], top - 70, [-225, column_y, 225, 760], top, 12);
    for (s = [-1, 1]) block_at([s * z_rail_x - 40, column_y - 6, 690], [s * z_rail_x + 40, column_y + 30, top - 6], 3);
  }
  // triangular and square windows of a ribbed casting, 40 deep on both sides
  for (s = [0, 1]) mirror([s, 0, 0]) for (k = [0:3]) {
    z = 690 + k * 310;
    w = 200 - k * 12;
    translate([180, 0, 0]) rotate([0, 90, 0]) linear_extrude(height = 120) soft(12)
      polygon([[-z, 530], [-z - 250, 530], [-z - 250, 530 + w * 0.45], [-z, 530 + w]]);
    translate([180, 0, 0]) rotate([0, 90, 0]) linear_extrude(height = 120) soft(10)
      polygon([[-z - 60, 540 + w], [-z - 250, 540 + w * 0.62], [-z - 250, 540 + w]]);
  }
  // front trough for the ball screw
  block_at([-90, column_y - 50, 700], [90, column_y + 60, top - 40], 10);
}
// foot screws
for (s = [-1, 1], y = [520, 620, 720, 810]) translate([s * 262, y, way_z + 18]) disc(13, 16, 1.5, $fn = 6);
