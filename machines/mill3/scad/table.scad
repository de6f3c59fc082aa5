// Table: three T-slots along X, coolant gutter around the clamping face, trucks on the X rails.
include <params.scad>

difference() {
  union() {
    plate_at([-table_x, -table_y, 756], [table_x, table_y, table_top], 12, 2);
    block_at([-table_x + 40, -table_y + 16, 738], [table_x - 40, table_y - 16, 757], 4);
    for (sx = [-1, 1], sy = [-1, 1])
      block_at([sx * 150 - 60, sy * x_rail_y - 40, x_rail_z + 14], [sx * 150 + 60, sy * x_rail_y + 40, 740], 3);
    block_at([-60, -38, x_rail_z - 18], [60, 38, 740], 5);
  }
  for (y = [-125, 0, 125]) t_slot(-table_x - 5, table_x + 5, y, table_top);
  for (s = [-1, 1]) block_at([s * x_rail_y * 0 - 300, s * x_rail_y - 16, x_rail_z + 4], [300, s * x_rail_y + 16, x_rail_z + 29], 1);
  translate([-400, 0, x_rail_z + 6]) rotate([0, 90, 0]) cylinder(r = 15, h = 800, $fn = 28);
  // gutter along the front and the back, and the step of the clamping face
  for (s = [0, 1]) mirror([0, s, 0]) {
    profile_yz([[-table_y + 10, table_top + 1], [-table_y + 10, table_top - 9], [-table_y + 14, table_top - 12],
                [-table_y + 26, table_top - 12], [-table_y + 30, table_top - 9], [-table_y + 30, table_top + 1]],
               -table_x + 14, table_x - 14);
    // scale groove on the edge
    profile_yz([[-table_y - 1, 778], [-table_y + 5, 781], [-table_y + 5, 797], [-table_y - 1, 800]], -table_x - 1, table_x + 1);
  }
}
