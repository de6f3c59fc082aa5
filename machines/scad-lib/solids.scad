// Shapes that every machine of this folder is made of. Millimetres; Z up.
// All of them are closed solids whose edges are broken, as on a real machine.

$fn = 32;
eps = 0.01;  // overlap of parts that become one solid

// Block with its corner at the origin and every edge chamfered by c.
module block(size, c = 2) {
  x = size[0]; y = size[1]; z = size[2];
  hull() {
    translate([c, c, 0]) cube([x - 2 * c, y - 2 * c, z]);
    translate([c, 0, c]) cube([x - 2 * c, y, z - 2 * c]);
    translate([0, c, c]) cube([x, y - 2 * c, z - 2 * c]);
  }
}

// The same between two corners.
module block_at(a, b, c = 2) {
  translate(a) block(b - a, c);
}

// Plate with rounded vertical edges (radius r) and chamfered rims (c), between two corners.
module plate_at(a, b, r = 10, c = 1) {
  s = b - a;
  translate([a[0] + r, a[1] + r, a[2]]) hull() for (x = [0, s[0] - 2 * r], y = [0, s[1] - 2 * r])
    translate([x, y, 0]) {
      cylinder(r = r - c, h = s[2], $fn = 24);
      translate([0, 0, c]) cylinder(r = r, h = s[2] - 2 * c, $fn = 24);
    }
}

// Frustum between two rectangles [x0, y0, x1, y1] at heights za < zb, corners rounded by r.
module taper(ra, za, rb, zb, r = 12) {
  hull() {
    for (x = [ra[0] + r, ra[2] - r], y = [ra[1] + r, ra[3] - r])
      translate([x, y, za]) cylinder(r = r, h = 0.5, $fn = 24);
    for (x = [rb[0] + r, rb[2] - r], y = [rb[1] + r, rb[3] - r])
      translate([x, y, zb - 0.5]) cylinder(r = r, h = 0.5, $fn = 24);
  }
}

// Cylinder along Z with chamfered rims.
module disc(r, h, c = 1) {
  rotate_extrude() polygon([[0, 0], [r - c, 0], [r, c], [r, h - c], [r - c, h], [0, h]]);
}

// Cylinders along X and Y: from the origin in the positive direction.
module disc_x(r, h, c = 1) { rotate([0, 90, 0]) disc(r, h, c); }
module disc_y(r, h, c = 1) { rotate([-90, 0, 0]) disc(r, h, c); }

// Solid of revolution about Z from points [r, z].
module turned(points) { rotate_extrude() polygon(points); }

// Polygon in the Y-Z plane, extruded along X from x0 to x1.
module profile_yz(points, x0, x1) {
  translate([x0, 0, 0]) rotate([90, 0, 90]) linear_extrude(height = x1 - x0) polygon(points);
}

// Polygon in the X-Z plane, extruded along Y from y0 to y1.
module profile_xz(points, y0, y1) {
  translate([0, y1, 0]) rotate([90, 0, 0]) linear_extrude(height = y1 - y0) polygon(points);
}

// Rounded 2-D polygon: every convex and concave corner gets radius r.
module soft(r) { offset(r = r) offset(delta = -r) children(); }

// Linear guide rail, length l along +X from the origin, w wide, h high, centred on Y, with its
// waist and the bolt counterbores that make it a guide rail.
module rail_x(l, w = 30, h = 26, pitch = 80) {
  difference() {
    rotate([90, 0, 90]) linear_extrude(height = l) polygon([
      [-w / 2, 0], [w / 2, 0], [w / 2, h * 0.35], [w * 0.36, h * 0.5], [w * 0.36, h * 0.62],
      [w / 2, h * 0.75], [w / 2, h * 0.94], [w * 0.44, h], [-w * 0.44, h], [-w / 2, h * 0.94],
      [-w / 2, h * 0.75], [-w * 0.36, h * 0.62], [-w * 0.36, h * 0.5], [-w / 2, h * 0.35]]);
    n = floor(l / pitch);
    for (i = [0:n - 1]) translate([l / 2 + (i - (n - 1) / 2) * pitch, 0, h * 0.55])
      cylinder(r = w * 0.24, h = h, $fn = 16);
  }
}

// T-slot cutter along X, from x0 to x1 at y, top face at z. w slot, t head width.
module t_slot(x0, x1, y, z, w = 14, t = 24, neck = 13, head = 11) {
  profile_yz([[y - w / 2 - 1, z + 1], [y - w / 2, z - 1], [y - w / 2, z - neck],
              [y - t / 2, z - neck], [y - t / 2, z - neck - head], [y + t / 2, z - neck - head],
              [y + t / 2, z - neck], [y + w / 2, z - neck], [y + w / 2, z - 1],
              [y + w / 2 + 1, z + 1]], x0, x1);
}

// Socket-head screw, head on the plane z = 0.
module socket_screw(d = 8) {
  difference() {
    disc(d * 0.8, d, 0.6, $fn = 20);
    translate([0, 0, d * 0.45]) cylinder(r = d * 0.46, h = d, $fn = 6);
  }
}

// Servo motor, flange on z = 0, shaft side down, body upwards: a square of side a, height h.
module servo(a, h) {
  difference() {
    union() {
      plate_at([-a / 2, -a / 2, 0], [a / 2, a / 2, h * 0.12], a * 0.1);
      plate_at([-a * 0.46, -a * 0.46, h * 0.11], [a * 0.46, a * 0.46, h * 0.78], a * 0.12);
      plate_at([-a * 0.42, -a * 0.42, h * 0.77], [a * 0.42, a * 0.42, h], a * 0.16, 2);
      translate([a * 0.40, -a * 0.16, h * 0.62]) block([a * 0.22, a * 0.32, h * 0.16], 2);
    }
    for (s = [-1, 1], k = [-1, 1], i = [1:3]) {
      translate([s * a * 0.46 - 2, k * a * 0.05 * i * 2 - 2, h * 0.18]) cube([4, 4, h * 0.52]);
    }
  }
}
