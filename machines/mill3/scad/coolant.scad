// Two coolant nozzles on a ring at the spindle housing; they end above the gauge face.
include <params.scad>

module hose(points, r) {
  for (i = [0:len(points) - 2]) hull() {
    translate(points[i]) sphere(r, $fn = 14);
    translate(points[i + 1]) sphere(r * 0.94, $fn = 14);
  }
}
for (s = [0, 1]) mirror([s, 0, 0]) {
  block_at([88, -30, nose_z + 74], [124, 12, nose_z + 110], 5);
  hose([[112, -9, nose_z + 80], [122, -22, nose_z + 52], [112, -38, nose_z + 30], [90, -42, nose_z + 16]], 8);
  hull() {
    translate([90, -42, nose_z + 16]) sphere(7, $fn = 14);
    translate([76, -38, nose_z + 9]) sphere(3.5, $fn = 14);
  }
}
