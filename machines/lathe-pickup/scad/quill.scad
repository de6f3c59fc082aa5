// Z slide with the spindle, which hangs head down.
include <params.scad>

x = axis_x;
difference() {
  union() {
    block_at([x - 200, 158, 1660], [x + 200, 206, 2240], 8);
    hull() {
      translate([x, 0, 1660]) disc(128, 580, 10, $fn = 48);
      block_at([x - 150, 120, 1660], [x + 150, 165, 2240], 6);
    }
    translate([x, 0, 1612]) turned([[0, 0], [66, 0], [70, 26], [98, 36], [98, 60], [0, 60]], $fn = 48);
  }
  for (s = [-1, 1]) translate([x + s * 128 - 20, -40, 1780]) cube([40, 80, 340]);
}
translate([x, 0, 2235]) disc(112, 260, 10, $fn = 40);
