// Lower way cover of the column, fixed: two folded sheets, one step in front of the other.
include <params.scad>

difference() {
  union() {
    block_at([-232, column_y - 34, 600], [232, column_y - 27, 1030], 1.5);
    for (s = [0, 1]) mirror([s, 0, 0]) block_at([226, column_y - 34, 600], [232, column_y + 2, 1030], 1.5);
    for (z = [640, 760, 880, 1000]) block_at([-215, column_y - 35.5, z], [215, column_y - 33, z + 12], 1);
  }
}
