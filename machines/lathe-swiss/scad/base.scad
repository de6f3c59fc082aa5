// Base with a chip drawer.
include <params.scad>

difference() {
  union() {
    taper([-820, -430, 900, 430], 50, [-800, -420, 880, 420], 500, 24);
    taper([-800, -420, 880, 420], 499.5, [-720, -400, 800, 400], axis_z + top, 16);
  }
  block_at([-200, -470, 160], [620, -300, 420], 20);
  for (s = [-1, 1]) translate([s > 0 ? 860 : -840, -250, 180]) cube([60, 500, 260]);
}
block_at([-190, -440, 165], [610, -310, 330], 10);
for (x = [-740, 820], y = [-360, 360]) translate([x, y, 0]) { disc(45, 18, 3); translate([0, 0, 16]) cylinder(r = 16, h = 40, $fn = 20); }
