// Trunnion base on the table: a plate, two brackets with the bearings of A, gear box on the right.
include <params.scad>

plate_at([-300, -120, table_top - eps], [330, 120, table_top + 26], 10, 2);
for (s = [-1, 1]) {
  difference() {
    union() {
      profile_yz([[-112, table_top + 20], [112, table_top + 20], [100, table_top + 60], [66, a_z + 10], [66, a_z + 66],
                  [-66, a_z + 66], [-66, a_z + 10], [-100, table_top + 60]],
                 s > 0 ? bracket_x : -bracket_x - 70, s > 0 ? bracket_x + 70 : -bracket_x);
      translate([s > 0 ? bracket_x + 60 : -bracket_x - 86, 0, a_z]) disc_x(58, 26, 4);
    }
    // bore of the bearing and a window in the foot
    translate([-400, 0, a_z]) rotate([0, 90, 0]) cylinder(r = 34, h = 800, $fn = 48);
    translate([s * (bracket_x + 35), 0, table_top + 70]) rotate([0, 90, 0]) linear_extrude(height = 100, center = true)
      soft(8) translate([-22, -44]) square([44, 88]);
  }
}
// clamps in the table's T-slots
for (x = [-285, 315], y = [-90, 90]) translate([x - 6, y, table_top + 25]) disc(9, 12, 1.5, $fn = 6);
