// Saddle: slide of X.
include <params.scad>

difference() {
  union() {
    block_at([-330, 165, 2440], [330, 212, 3080], 8);
    block_at([-240, -190, 2460], [240, 175, 3040], 14);
    for (x = [-300, 160], z = [2495, 2945]) block_at([x, 195, z], [x + 140, 236, z + 70], 4);
  }
  block_at([-162, -162, 2400], [162, 162, 3200], 2);
}
translate([-270, 120, 3075]) motor(120, 190);
