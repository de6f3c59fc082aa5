// Saddle: slide of X, with the guide of the ram.
include <params.scad>

x = gauge_x;
difference() {
  union() {
    block_at([x - 210, 90, 1130], [x + 210, 172, 1510], 10);
    block_at([x - 140, -125, 1150], [x + 140, 110, 1490], 16);
    for (s = [-1, 1], z = [1165, 1425]) block_at([x + s * 150 - 50, 150, z], [x + s * 150 + 50, 196, z + 50], 5);
  }
  block_at([x - 88, -88, 1100], [x + 88, 88, 1600], 1);
}
translate([x - 175, 40, 1505]) motor(100, 170);
block_at([x - 220, -10, 1495], [x + 100, 90, 1512], 3);
