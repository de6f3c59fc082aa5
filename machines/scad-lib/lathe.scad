// Parts of lathes. Each is in the frame of its unit:
//   x  along the spindle, out of its chuck; the chuck's face is x = 0, the spindle's axis y = z = 0
//   y  radial, the way in which X of the unit grows
//   z  away from the bed, so the slides lie at negative z
// Meshes of units are made in this frame; `pose` of the body in machine.toml puts them on a slanted
// bed, which keeps the numbers here simple and OpenSCAD fast.
include <solids.scad>

way = -330;      // z of the bed's upper face
pitch_r = 150;   // the driven station of a turret is this far from the turret's axis

// Upper side of a slanted bed, seen from the world: [Y, Z] of the unit's point (y, z).
function slanted(a, h, y, z) = [y * cos(a) - z * sin(a), h + y * sin(a) + z * cos(a)];

// ---- workpiece side ----

// Three-jaw power chuck of radius r, l long; grip is the radius that the jaws hold.
module chuck(r = 105, l = 95, grip = 30, jaw = 42) {
  difference() {
    translate([-l, 0, 0]) rotate([0, 90, 0])
      turned([[0, 0], [r - 8, 0], [r, 8], [r, l - 30], [r - 2, l - 28], [r - 2, l - 24], [r, l - 22], [r, l - 4],
              [r - 4, l], [0, l]], $fn = 72);
    translate([-l - 1, 0, 0]) rotate([0, 90, 0]) cylinder(r = r * 0.24, h = l + 2, $fn = 40);
    for (k = [0:2]) rotate([k * 120 + 60, 0, 0]) translate([-6, 0, r * 0.72]) rotate([0, 90, 0]) cylinder(r = 7, h = 10, $fn = 16);
  }
  for (k = [0:2]) rotate([k * 120, 0, 0])
    profile_xz([[-10, grip], [jaw, grip], [jaw, grip + 15], [jaw * 0.6, grip + 15], [jaw * 0.6, grip + 33], [20, grip + 33],
                [20, r - 3], [-10, r - 3]], -r * 0.13, r * 0.13);
}

// The bar that is held: picture only.
module bar(r = 29.6, x1 = 170, x0 = -60) { translate([x0, 0, 0]) disc_x(r, x1 - x0, 1, $fn = 64); }

// Headstock between x0 and x1, standing on the bed; the spindle's nose reaches from x1 to the chuck.
module headstock(x0, x1, w = 175, top = 160, foot = way) {
  difference() {
    union() {
      hull() {
        translate([x0, 0, 0]) disc_x(top, x1 - x0, 14, $fn = 48);
        block_at([x0, -w, foot + 70], [x1, w, foot + 110], 8);
      }
      block_at([x0 - 20, -w - 28, foot], [x1 + 12, w + 28, foot + 72], 8);
      for (x = [x0 + 60, (x0 + x1) / 2 - 10, x1 - 80]) hull() {
        translate([x, 0, 0]) disc_x(top + 8, 22, 4, $fn = 48);
        block_at([x, -w - 10, foot + 60], [x + 22, w + 10, foot + 80], 3);
      }
    }
    translate([x0 - 30, 0, 0]) rotate([0, 90, 0]) cylinder(r = 40, h = 90, $fn = 40);
  }
  translate([x1 - 2, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [98, 0], [98, 12], [88, 20], [70, 20], [66, 30], [0, 30]], $fn = 56);
  for (k = [0:7]) rotate([k * 45 + 22, 0, 0]) translate([x1 + 9, 0, 82]) rotate([0, 90, 0]) disc(6, 6, 1, $fn = 12);
  for (y = [-w - 12, w + 12], x = [x0 + 20, x1 - 30]) translate([x, y, foot + 70]) disc(13, 14, 2, $fn = 6);
}

// Main motor beside the headstock, with the guard of the belt on its left end; `side` is where it
// lies in y.
module main_drive(x0, x1, side = 1, foot = way) {
  y = side * 330;
  translate([x0, y, foot + 175]) {
    disc_x(118, x1 - x0 - 40, 8, $fn = 48);
    for (k = [0:7]) rotate([k * 45, 0, 0]) translate([30, -5, 110]) cube([x1 - x0 - 130, 10, 16]);
    block_at([60, -60, 110], [200, 60, 165], 5);
  }
  block_at([x0 + 20, y - 140, foot], [x1 - 60, y + 140, foot + 60], 5);
  hull() {
    translate([x0 - 85, 0, 0]) disc_x(120, 62, 10, $fn = 40);
    translate([x0 - 85, y, foot + 175]) disc_x(95, 62, 10, $fn = 40);
  }
  for (k = [0:5]) translate([x0 - 87, side * (60 + k * 30), -20 - k * 12]) rotate([0, 0, 0]) block([4, 12, 90], 1);
}

// Tailstock with its centre at x = 0, on rails at y0 and y1.
module tailstock(y0 = -90, y1 = 70, foot = way + 24) {
  difference() {
    union() {
      hull() {
        translate([90, 0, 0]) disc_x(78, 250, 8, $fn = 48);
        block_at([90, y0 - 30, foot + 50], [360, y1 + 30, foot + 80], 6);
      }
      block_at([80, y0 - 45, foot - 18], [380, y1 + 45, foot + 56], 6);
    }
    translate([330, 0, 0]) rotate([0, 90, 0]) cylinder(r = 46, h = 40, $fn = 32);
  }
  translate([30, 0, 0]) disc_x(44, 70, 4, $fn = 48);
  rotate([0, 90, 0]) turned([[0, 0], [24, 42], [24, 60], [0, 60]], $fn = 40);
  translate([338, 0, 0]) disc_x(30, 60, 4, $fn = 32);
  translate([200, -20, 70]) cube([30, 40, 50]);
  translate([205, -20, 108]) cube([16, 16, 90]);
}

// Servo motor on its flange in z = 0: square of side a, height h.
module motor(a, h) {
  block_at([-a / 2, -a / 2, 0], [a / 2, a / 2, h * 0.12], 3);
  block_at([-a * 0.44, -a * 0.44, h * 0.1], [a * 0.44, a * 0.44, h * 0.78], a * 0.08);
  block_at([-a * 0.4, -a * 0.4, h * 0.76], [a * 0.4, a * 0.4, h], a * 0.1);
  block_at([a * 0.36, -a * 0.16, h * 0.6], [a * 0.6, a * 0.16, h * 0.8], 3);
}

// ---- tool side. g = x of the gauge point with the Z slide at zero ----

// Z slide: from y0 to y1, on rails that lie along x at `rails`.
module carriage(g, y0 = 20, y1 = 560, rails = [70, 400]) {
  difference() {
    union() {
      block_at([g + 60, y0, way + 30], [g + 380, y1, -252], 6);
      for (y = rails, x = [g + 66, g + 274]) block_at([x, y - 42, way + 5], [x + 100, y + 42, way + 40], 4);
      for (x = [g + 88, g + 322]) block_at([x - 2, y0 + 6, -256], [x + 32, y1 - 6, -246], 2);
    }
    block_at([g + 150, y0 + 50, way], [g + 300, y1 - 60, way + 50], 6);
    block_at([g + 170, y0 - 5, -270], [g + 270, y1 - 80, -240], 4);
  }
  // drive of the cross slide
  translate([g + 220, y1 - 4, -248]) rotate([-90, 0, 0]) motor(96, 150);
  // ball screw of the cross slide
  translate([g + 220, y0 + 20, -246]) disc_y(12, y1 - y0 - 40, 2);
}

module carriage_ways(g, y0 = 20, y1 = 560) {
  for (x = [g + 103, g + 337]) translate([x, y0 + 8, -250]) rotate([0, 0, 90]) rail_x(y1 - y0 - 16, 28, 24, 130);
}

// Plate of an X slide on its carriage; y = of the turret's axis, shift = how far the plate lies
// behind it.
module slide_plate(g, y, shift = 0) {
  block_at([g + 84, y - 130 + shift, -236], [g + 356, y + 150 + shift, -188], 5);
}

// Housing of a disc turret with its indexing motor; its foot is at z = foot.
module turret_housing(g, y, shift = 0, foot = -190) {
  difference() {
    union() {
      hull() {
        block_at([g + 120, y - 105 + shift, foot], [g + 345, y + 125 + shift, foot + 40], 6);
        translate([g + 96, y, 0]) disc_x(104, 220, 10, $fn = 32);
      }
      translate([g + 88, y, 0]) disc_x(92, 30, 4, $fn = 40);
      translate([g + 310, y, 0]) disc_x(66, 46, 6, $fn = 40);
    }
    for (s = [-1, 1]) translate([g + 150, y + s * 128 - 20, -130]) cube([140, 40, 70]);
  }
  translate([g + 210, y + 40, 92]) motor(110, 150);
  block_at([g + 96, y - 60, 96], [g + 150, y + 70, 112], 4);
}

// X slide with a disc turret's housing; `reach` = y of the turret's axis with the slide at zero.
module cross_slide(g, reach = pitch_r, shift = 0) {
  slide_plate(g, reach, shift);
  turret_housing(g, reach, shift);
}

// X slide with the seat of a swivelling turret, whose axis is at x = g + 220, along z.
module swivel_seat(g, reach = pitch_r) {
  slide_plate(g, reach);
  translate([g + 220, reach, -190]) cylinder(r = 118, h = 36, $fn = 48);
  translate([g + 220, reach, -156]) cylinder(r = 96, h = 8, $fn = 48);
}
// What swivels on it, without the disc.
module swivel_turret(g, reach = pitch_r) {
  turret_housing(g, reach, 0, -146);
  translate([g + 220, reach, -147]) cylinder(r = 110, h = 20, $fn = 48);
}

// X slide with the bearing of a milling head that swivels about y; the axis is at x = g + 140.
module head_bearing(g, shift = 150) {
  slide_plate(g, pitch_r, shift);
  difference() {
    union() {
      hull() {
        block_at([g + 100, 190, -190], [g + 330, 400, -150], 6);
        block_at([g + 60, 150, -80], [g + 240, 360, 80], 8);
      }
      translate([g + 140, 96, 0]) disc_y(92, 240, 6, $fn = 48);
    }
    for (x = [g + 40, g + 246]) translate([x, 240, -60]) cube([30, 90, 110]);
  }
  translate([g + 140, 330, 0]) rotate([-90, 0, 0]) motor(110, 160);
}
// The milling head: its gauge face looks towards the chuck.
module milling_head(g) {
  translate([g, 0, 0]) rotate([0, 90, 0])
    turned([[0, 0], [30, 0], [34, 4], [34, 24], [48, 30], [55, 40], [55, 270], [45, 290], [0, 290]], $fn = 48);
  translate([g + 140, 30, 0]) disc_y(84, 60, 4, $fn = 48);
  block_at([g + 70, -20, -50], [g + 210, 60, 50], 8);
}

// A turret's disc with its axis along x in y = 0: the front face is x = 8, the driven station
// lies at y = -pitch_r with its gauge face in x = 0.
module turret_disc(n = 8, t = 82) {
  flat = 108;
  rotate([0, 90, 0]) rotate([0, 0, 180 / n]) translate([0, 0, 8]) cylinder(r = flat / cos(180 / n), h = t, $fn = n);
  translate([-2, 0, 0]) rotate([0, 90, 0]) cylinder(r1 = 46, r2 = 52, h = 12, $fn = 32);
  driven_station();
  for (k = [1:n - 1]) rotate([k * 360 / n, 0, 0])
    if (k % 2 == 0) boring_station(); else turning_station();
}
// Holder of a turning tool along x: its nose is the gauge face.
module driven_station() {
  block_at([10, -pitch_r - 32, -30], [84, -104, 30], 5);
  translate([0, -pitch_r, 0]) rotate([0, 90, 0]) turned([[0, 0], [22, 0], [25, 3], [25, 12], [0, 12]], $fn = 32);
}
module boring_station() {
  translate([12, -150, -28]) cube([70, 50, 56]);
  translate([4, -128, 0]) rotate([0, 90, 0]) cylinder(r = 17, h = 12, $fn = 20);
}
module turning_station() {
  translate([14, -142, -27]) cube([64, 40, 54]);
  translate([26, -174, -10]) cube([20, 40, 20]);
  translate([22, -178, -2]) cube([16, 16, 7]);
}

// Rails along x from x0 to x1 on the bed.
module ways(x0, x1, rails = [70, 400]) {
  for (y = rails) translate([x0, y, way - 1]) rail_x(x1 - x0, 34, 28, 200);
  if (len(rails) > 1) translate([x0, (rails[0] + rails[1]) / 2, way + 16]) rotate([0, 90, 0]) cylinder(r = 14, h = x1 - x0, $fn = 20);
  if (len(rails) > 1) for (x = [x0, x1 - 60]) translate([x, (rails[0] + rails[1]) / 2 - 35, way - 1]) cube([60, 70, 46]);
}

// ---- frame of the machine (world axes: X along the spindle, Y away from the operator, Z up) ----

// Slanted bed casting between x0 and x1; the bed's face reaches from y0 to y1 of the unit.
module slant_base(x0, x1, a, h, y0, y1, front = -250, back = 760) {
  lo = slanted(a, h, y0, way);
  hi = slanted(a, h, y1, way);
  difference() {
    profile_yz([[front + 30, 60], [back, 60], [back, hi[1] - 120], [back - 50, hi[1]], hi, lo, [lo[0] - 40, lo[1] - 20],
                [front, lo[1] * 0.72], [front, 110]], x0, x1);
    // core windows in the ends and along the back
    for (x = [x0 - 1, x1 - 40]) translate([x, 0, 0]) rotate([90, 0, 90]) linear_extrude(height = 41) soft(30)
      polygon([[front + 90, 150], [back - 90, 150], [back - 90, hi[1] - 220], [lo[0] + 120, lo[1] - 60], [front + 90, lo[1] * 0.55]]);
    n = floor((x1 - x0) / 420);
    for (i = [0:n - 1]) translate([x0 + (i + 0.5) * (x1 - x0) / n, back, 0]) rotate([90, 0, 0]) linear_extrude(height = 60, center = true)
      soft(26) translate([-140, 180]) square([280, hi[1] - 440]);
  }
  for (x = [x0 + 90, (x0 + x1) / 2, x1 - 90], y = [front + 90, back - 80]) translate([x, y, 0]) {
    disc(52, 18, 3);
    translate([0, 0, 16]) cylinder(r = 18, h = 50, $fn = 20);
  }
}

// Chip tray with splash guards: floor, low front wall, left and right walls, high back wall.
module tray(x0, x1, front, back, low = 720, high = 1500, lip = 420) {
  t = 5;
  difference() {
    profile_yz([[front, lip], [front, low], [front + 50, low], [front + 190, low + 260], [back - 30, high], [back, high],
                [back, lip]], x0, x1);
    profile_yz([[front + t, lip + t], [front + t, low + 40], [front + 46, low + 40], [front + 185, low + 300],
                [back - t - 30, high + 60], [back - t, high + 60], [back - t, lip + t]], x0 + t, x1 - t);
    // the front is open above its sill
    block_at([x0 + 90, front - 60, low - 60], [x1 - 90, front + 400, high + 90], 2);
    // floor and back give way to the bed
    block_at([x0 + 40, front + 150, lip - 10], [x1 - 40, back - 40, lip + 40], 2);
  }
  block_at([x0 + 60, front - 8, low - 74], [x1 - 60, front + 10, low - 52], 3);
  for (x = [x0 + 60, x1 - 180]) block_at([x, front + 4, 20], [x + 120, front + 60, lip + 8], 5);
}

// Control panel, its box at the origin, on an arm that leads back.
module control_panel(arm = 300) {
  translate([0, 0, -20]) difference() {
    union() {
      block_at([-180, -40, -190], [180, 60, 270], 10);
        for (i = [0:7], j = [0:3]) translate([-150 + 24 * i, -45, -150 + 26 * j]) cube([18, 10, 18]);
      translate([115, -39, -110]) rotate([90, 0, 0]) disc(26, 26, 4);
      translate([115, -39, -30]) rotate([90, 0, 0]) disc(20, 14, 2);
    }
    block_at([-155, -60, 25], [155, -34, 240], 1);
  }
  block_at([-40, 40, 40], [40, 120, 120], 6);
  block_at([-30, 100, 50], [30, 100 + arm, 110], 6);
}

// Holder behind a turret's housing for a tool that looks away from the chuck: its gauge face is
// x = g + 404, on the spindle's axis with the X slide at zero.
module back_tool(g) {
  block_at([g + 330, -32, -32], [g + 394, 130, 32], 5);
  translate([g + 392, 0, 0]) rotate([0, 90, 0]) turned([[0, 0], [25, 0], [25, 9], [22, 12], [0, 12]], $fn = 32);
}
