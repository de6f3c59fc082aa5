// Head, second axis: the spindle, which A tilts. The gauge face is its lower end.
include <params.scad>

translate([axis_a[0], axis_a[1], face[2]]) turned([
  [0, 0], [44, 0], [46, 2], [46, 20], [64, 26], [82, 60], [86, 66], [86, 420], [70, 440], [0, 440]], $fn = 56);
translate([-92, axis_a[1], axis_a[2]]) disc_x(72, 184, 3, $fn = 48);
block_at([-40, axis_a[1] + 70, axis_a[2] - 60], [40, axis_a[1] + 104, axis_a[2] + 120], 6);
