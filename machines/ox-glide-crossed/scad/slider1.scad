// Slider 1 on the lower guide. Pins for rod 1 at (0, -d) and for its parallel link at par from it.
include <params.scad>

module pin(x, z, r) {
  translate([x, -slider_out + 1, z]) rotate([90, 0, 0]) {
    disc(r + 6, rod_in - slider_out, 0.8, $fn = 28);
    cylinder(r = r, h = rod_out - slider_out + 3, $fn = 28);
    translate([0, 0, rod_out - slider_out + 2]) disc(r + 6, 7, 1.5, $fn = 28);
    translate([0, 0, rod_out - slider_out + 8.5]) disc(r * 0.7, 4, 0.8, $fn = 6);
  }
}
difference() {
  union() {
    block_at([-46, -slider_out, -d - 40], [46, -127, -d + 40], 5);
    hull() {
      block_at([-46, -slider_out, -d - 20], [46, -130, -d + 38], 5);
      block_at([-54, -slider_out, -d + 44], [-6, -130, -d + 82], 5);
    }
    for (z = [-28, 28]) block_at([-42, -129, -d + z - 15], [42, -slider_in, -d + z + 15], 2);
    block_at([-30, -129, -d - 11], [30, -slider_in - 1, -d + 11], 2);
  }
  for (z = [-28, 28]) block_at([-60, -125, -d + z - 10], [60, -100, -d + z + 10], 0.5);
  translate([-60, -126, -d]) rotate([0, 90, 0]) cylinder(r = 8.5, h = 120, $fn = 24);
}
pin(0, -d, 11);
pin(par[0], -d + par[1], 8);
