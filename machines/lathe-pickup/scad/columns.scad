// Columns and beam of the X slide.
include <params.scad>

for (x = [-1120, 210]) difference() {
  taper([x, 340, x + 190, 650], 555, [x, 340, x + 190, 640], 1820, 12);
  for (z = [700, 1180]) block_at([x - 10, 420, z], [x + 200, 570, z + 340], 24);
}
difference() {
  block_at([-1130, 345, 1760], [410, 650, 2180], 14);
  for (i = [0:4]) block_at([-1080 + i * 295, 620, 1830], [-850 + i * 295, 690, 2110], 16);
}
