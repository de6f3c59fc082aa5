// Z rails, Z ball screw with its bearing blocks, Z motor on top of the column.
include <params.scad>

for (s = [-1, 1]) translate([s * z_rail_x, column_y - 5.5, 700]) rotate([0, -90, 0]) rotate([-90, 0, 0])
  rotate([180, 0, 0]) translate([0, 0, 0]) rail_x(1280, 32, 25, 100);
translate([0, column_y + 10, 720]) cylinder(r = 17, h = 1250, $fn = 28);
for (z = [702, 1910]) block_at([-60, column_y - 15, z], [60, column_y + 61, z + 48], 5);
translate([0, column_y + 40, 2000 - eps]) servo(130, 200);
