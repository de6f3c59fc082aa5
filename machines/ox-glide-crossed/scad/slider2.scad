// Slider 2 on the upper guide. Pin for rod 2 at (0, +d).
include <params.scad>

mirror([0, 1, 0]) {
  difference() {
    union() {
      block_at([-50, -slider_out, d - 40], [50, -127, d + 40], 5);
      hull() {
        translate([0, -slider_out + 0.5, d]) rotate([90, 0, 0]) disc(30, 5, 1.5, $fn = 40);
        translate([0, -slider_out + 6, d]) rotate([90, 0, 0]) disc(36, 5, 1.5, $fn = 40);
      }
      for (z = [-28, 28]) block_at([-46, -129, d + z - 15], [46, -slider_in, d + z + 15], 2);
      block_at([-30, -129, d - 11], [30, -slider_in - 1, d + 11], 2);
    }
    for (z = [-28, 28]) block_at([-60, -125, d + z - 10], [60, -100, d + z + 10], 0.5);
    translate([-60, -126, d]) rotate([0, 90, 0]) cylinder(r = 8.5, h = 120, $fn = 24);
  }
  translate([0, -slider_out + 1, d]) rotate([90, 0, 0]) {
    disc(18, rod_in - slider_out, 0.8, $fn = 28);
    cylinder(r = 12, h = rod_out - slider_out + 3, $fn = 28);
    translate([0, 0, rod_out - slider_out + 2]) disc(18, 7, 1.5, $fn = 28);
    translate([0, 0, rod_out - slider_out + 8.5]) disc(9, 4, 0.8, $fn = 6);
  }
}
