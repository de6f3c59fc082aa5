// Cover below the carriage: slides in front of the column's fixed cover, moves with the head.
include <params.scad>

difference() {
  union() {
    block_at([-240, column_y - 44, nose_z - 350], [240, column_y - 38, nose_z + 70], 1.5);
    for (s = [0, 1]) mirror([s, 0, 0]) block_at([234, column_y - 44, nose_z - 350], [240, column_y - 10, nose_z + 70], 1.5);
    for (z = [-320, -190, -60]) block_at([-222, column_y - 46, nose_z + z], [222, column_y - 43, nose_z + z + 14], 1);
  }
}
