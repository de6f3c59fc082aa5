// Two columns with a tie on top.
include <params.scad>

for (x = [-320, 760]) difference() {
  union() {
    taper([x, 440, x + 280, 815], -42, [x, 440, x + 280, 760], 1640, 14);
    block_at([x - 14, 430, -42], [x + 294, 822, 8], 6);
  }
  for (z = [120, 560, 1000]) block_at([x + 60, 400, z], [x + 220, 470, z + 300], 20);
}
block_at([-330, 470, 1560], [1050, 780, 1680], 14);
