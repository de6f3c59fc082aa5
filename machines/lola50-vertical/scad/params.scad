// LOLA-50-type robot: measures and the shapes that the three packages share. Bodies are drawn in the
// arm's own axes {0} (shoulder in the origin, forearm forward along +X, Z up, joints at zero: upper arm
// upright, forearm level, flange down) and turned into bed axes by in_bed().
include <../../scad-lib/solids.scad>

a2 = 900;   // upper arm
d4 = 950;   // forearm
d6 = 150;   // wrist centre to flange
dt = 350;   // flange to the gauge face
floor_z = -800;

module in_bed() { rotate([0, 0, -90]) children(); }

// Cylinder along Y, from y0 to y1, at (x, z).
module hub(x, z, r, y0, y1, c = 4) { translate([x, y0, z]) disc_y(r, y1 - y0, c, $fn = 64); }

module base_body() {
  plate_at([-330, -330, floor_z], [330, 330, floor_z + 40], 40, 4);
  translate([0, 0, floor_z + 30]) turned([[0, 0], [280, 0], [250, 60], [220, 300], [220, 420], [235, 440], [235, 480], [0, 480]], $fn = 64);
  for (x = [-270, 270], y = [-270, 270]) translate([x, y, floor_z + 39]) disc(24, 22, 2, $fn = 6);
}

// Turret on joint 1 with two cheeks; the upper arm turns between them.
module turret_body() {
  translate([0, 0, -280]) turned([[0, 0], [225, 0], [235, 10], [235, 60], [200, 90], [0, 90]], $fn = 64);
  for (s = [-1, 1]) hull() {
    translate([0, s > 0 ? 120 : -170, 0]) disc_y(150, 50, 4, $fn = 64);
    block_at([-170, s > 0 ? 120 : -170, -200], [170, s > 0 ? 170 : -120, -190], 3);
  }
  hub(0, 0, 105, 168, 290);
  hub(0, 0, 105, -260, -168);
}

module upper_arm_body() {
  hub(0, 0, 140, -105, 105);
  hull() {
    hub(0, 60, 105, -90, 90);
    hub(0, a2 - 60, 80, -70, 70);
  }
  hub(0, a2, 110, -75, 75);
}

// Forearm: elbow cheeks outside of the upper arm, motors behind, tube to the wrist.
module forearm_body() {
  for (s = [-1, 1]) hull() {
    translate([0, s > 0 ? 88 : -128, a2]) disc_y(115, 40, 4, $fn = 64);
    block_at([150, s > 0 ? 88 : -128, a2 - 70], [230, s > 0 ? 128 : -88, a2 + 70], 4);
  }
  hull() {
    block_at([170, -128, a2 - 80], [240, 128, a2 + 80], 6);
    translate([330, 0, a2]) disc_x(85, 20, 3, $fn = 64);
  }
  translate([340, 0, a2]) disc_x(80, 375, 4, $fn = 64);
  for (y = [-45, 45]) translate([180, y, a2 + 60]) rotate([0, 0, 0]) servo(80, 150);
}

// Wrist housing on joint 4, a fork whose arms hold joint 5.
module wrist_body() {
  translate([725, 0, a2]) disc_x(78, 60, 3, $fn = 64);
  hull() {
    translate([780, 0, a2]) disc_x(76, 10, 2, $fn = 64);
    block_at([830, -105, a2 - 60], [845, 105, a2 + 60], 4);
  }
  for (s = [-1, 1]) hull() {
    block_at([830, s > 0 ? 75 : -105, a2 - 60], [845, s > 0 ? 105 : -75, a2 + 60], 3);
    translate([d4, s > 0 ? 75 : -105, a2]) disc_y(62, 30, 3, $fn = 48);
  }
}

// Hand on joint 5, down to z = flange + 30.
module hand_body() {
  hub(d4, a2, 58, -65, 65, 3);
  translate([d4, 0, a2 - 118]) cylinder(r1 = 50, r2 = 56, h = 118, $fn = 48);
}

// Flange, adapter and motor spindle; the gauge face is at the lower end.
module spindle_body(top) {
  translate([d4, 0, a2 - d6 - dt]) difference() {
    union() {
      turned([[0, 0], [24, 0], [28, 3], [28, 16], [44, 20], [50, 26], [50, 250], [0, 250]], $fn = 56);
      translate([0, 0, 249]) cylinder(r = 38, h = top - 249, $fn = 48);
      translate([0, 0, dt - 15]) disc(70, 15, 2, $fn = 48);
    }
    turned([[0, -1], [11.5, -1], [11.5, 0], [6.4, 35], [6.4, 60], [0, 60]], $fn = 40);
  }
  translate([d4 + 30, -14, a2 - d6 - dt + 190]) block([48, 28, 24], 3);
}
