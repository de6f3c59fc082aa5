// Head, first axis: C about the mount's axis, with the arms of the second one.
include <params.scad>

translate([0, 0, mount - 60]) disc(152, 58, 4, $fn = 64);
difference() {
  union() {
    block_at([-170, -150, mount - 330], [170, 105, mount - 50], 16);
    for (s = [-1, 1]) hull() {
      block_at([s > 0 ? 98 : -170, -60, mount - 330], [s > 0 ? 170 : -98, 100, mount - 200], 8);
      translate([s > 0 ? 98 : -170, axis_a[1], axis_a[2]]) disc_x(96, 72, 6, $fn = 48);
    }
  }
  for (s = [0, 1]) mirror([s, 0, 0]) block_at([160, -110, mount - 270], [200, 40, mount - 130], 12);
}
for (s = [-1, 1]) translate([s > 0 ? 168 : -192, axis_a[1], axis_a[2]]) disc_x(70, 24, 4, $fn = 40);
