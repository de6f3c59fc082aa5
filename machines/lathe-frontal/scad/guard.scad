// Guards behind and at the sides, with a roof over the drives.
include <params.scad>

difference() {
  block_at([-960, -200, 420], [960, 900, 1640], 10);
  block_at([-952, -260, 412], [952, 892, 1630], 6);
}
for (x = [-960, 900]) block_at([x, 700, 20], [x + 60, 860, 440], 6);
