// Base with a chip trough below the turret.
include <params.scad>

difference() {
  union() {
    taper([-1180, -380, 460, 680], 40, [-1160, -360, 440, 660], 300, 30);
    taper([-1160, -360, 440, 660], 299.5, [-1130, -340, 410, 650], 560, 20);
  }
  block_at([-560, -420, 360], [240, 120, 640], 20);
}
for (x = [-1100, -360, 380], y = [-300, 600]) translate([x, y, 0]) { disc(52, 18, 3); translate([0, 0, 16]) cylinder(r = 18, h = 40, $fn = 20); }
