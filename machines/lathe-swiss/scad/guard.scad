// Back wall and roof of the working space, magazine for bars on the left.
include <params.scad>

difference() {
  block_at([-740, -300, axis_z - 200], [820, 460, axis_z + 420], 8);
  block_at([-732, -360, axis_z - 260], [812, 452, axis_z + 360], 6);
  block_at([-700, -340, axis_z + 300], [780, -100, axis_z + 500], 6);
}
block_at([-2100, -60, axis_z - 60], [-720, 90, axis_z + 60], 10);
for (x = [-2000, -1100]) block_at([x, -40, 0], [x + 90, 70, axis_z - 55], 6);
