// Saddle: slides on the Y rails, carries the X rails. Wide at the top, narrow at the bottom.
include <params.scad>

difference() {
  union() {
    profile_xz([[-280, way_z + 36], [280, way_z + 36], [300, way_z + 60], [452, x_rail_z - 40],
                [456, x_rail_z - 6], [450, x_rail_z], [-450, x_rail_z], [-456, x_rail_z - 6],
                [-452, x_rail_z - 40], [-300, way_z + 60]], -205, 205);
    for (s = [-1, 1]) block_at([-440, s * x_rail_y - 30, x_rail_z - 30], [440, s * x_rail_y + 30, x_rail_z + 2], 2);
    // trucks on the Y rails
    for (sx = [-1, 1], sy = [-1, 1])
      block_at([sx * y_rail_x - 42, sy * 145 - 55, way_z + 8], [sx * y_rail_x + 42, sy * 145 + 55, way_z + 40], 3);
    // nut housing in the trough
    block_at([-40, -60, way_z - 70], [40, 60, way_z + 40], 6);
  }
  // the trucks' grooves, 1 mm clear of the rails; the screw's bore
  for (s = [-1, 1]) block_at([s * y_rail_x - 18, -300, way_z - 10], [s * y_rail_x + 18, 300, way_z + 31], 1);
  translate([0, -300, way_z - 30]) rotate([-90, 0, 0]) cylinder(r = 17, h = 600, $fn = 28);
  // pockets of the casting, front and back
  for (s = [0, 1]) mirror([0, s, 0]) for (x = [-235, -80, 75, 230])
    translate([x, -206, 612]) rotate([-90, 0, 0]) linear_extrude(height = 26) soft(8) translate([-62, -62]) square([124, 54]);
  // top trough between the X rails, with room for the screw
  profile_yz([[-95, x_rail_z + 20], [-80, x_rail_z - 36], [80, x_rail_z - 36], [95, x_rail_z + 20]], -380, 380);
}
