// A rod between two bearing eyes: upper joint in the origin, lower joint at z = -l, in the X-Z
// plane, thickness from y = 0 to y = t.
include <params.scad>

module rod(l, eye, bore, width, t) {
  module eyes(h) for (z = [0, -l]) translate([0, 0, z]) children();
  difference() {
    union() {
      for (z = [0, -l]) translate([0, 0, z]) disc_y(eye, t, 1.5, $fn = 40);
      // tapered bar, a little thinner than the eyes
      hull() for (z = [0, -l]) translate([0, 2, z]) disc_y(width / 2 + (z == 0 ? 1.5 : 0), t - 4, 1, $fn = 24);
      // ring of the bearing
      for (z = [0, -l]) translate([0, -0.7, z]) disc_y(bore + 5, t + 1.4, 0.6, $fn = 32);
    }
    for (z = [0, -l]) translate([0, -5, z]) rotate([-90, 0, 0]) cylinder(r = bore, h = t + 10, $fn = 32);
    // milled pockets make the bar an I section
    for (y = [-1, t - 5]) translate([0, y, 0]) hull() for (z = [-eye - width * 0.3 - 4, -l + eye + width * 0.3 + 4])
      translate([0, 0, z]) rotate([-90, 0, 0]) cylinder(r = width * 0.28, h = 6, $fn = 20);
  }
}
