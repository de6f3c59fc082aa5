// Guards behind and at the sides, with a roof over the drive.
include <params.scad>

difference() {
  block_at([-760, -330, 560], [1680, 1380, 1760], 10);
  block_at([-752, -400, 550], [1672, 1372, 1800], 6);
  block_at([-600, -360, 900], [1700, 700, 1900], 6);
}
for (x = [-760, 1610], y = [-320, 1300]) block_at([x, y, 20], [x + 70, y + 70, 580], 6);
