// Base casting: plinth, ribbed body, lands for the Y rails, rear deck for the column.
include <params.scad>

module side_pockets() {
  // core windows between the ribs, 25 deep, on both sides
  for (s = [0, 1]) mirror([s, 0, 0]) for (y = [-400, -230, -60, 110, 280, 580])
    translate([330, y, 210]) hull() for (a = [0, 130], b = [0, 200])
      translate([-15 + b * 0.0, a, b]) rotate([0, 90, 0]) cylinder(r = 14, h = 140, $fn = 20);
}

difference() {
  union() {
    taper([-430, -480, 430, 880], 40, [-425, -475, 425, 875], 130, 30);
    taper([-400, -455, 400, 865], 129.5, [-345, -445, 345, 860], 480, 30);
    taper([-345, -445, 345, 860], 479.5, [-300, -440, 300, 850], way_z - 12, 20);
    for (s = [-1, 1]) block_at([s * y_rail_x - 35, -440, way_z - 14], [s * y_rail_x + 35, 440, way_z], 3);
    block_at([-270, 450, way_z - 20], [270, 850, way_z + 20], 6);
  }
  side_pockets();
  // chip trough between the ways, open to the front
  profile_xz([[-150, way_z + 60], [-120, way_z - 90], [120, way_z - 90], [150, way_z + 60]], -700, 400);
  // front window with the maker's plate step
  translate([-170, -490, 200]) rotate([-90, 0, 0]) translate([0, -200, 0]) hull()
    for (a = [20, 320], b = [20, 180]) translate([a, b, 0]) cylinder(r = 20, h = 30, $fn = 20);
}
// levelling feet
for (x = [-380, 380], y = [-420, 200, 820]) translate([x, y, 0]) {
  disc(48, 18, 3);
  translate([0, 0, 17]) cylinder(r = 16, h = 30, $fn = 20);
}
