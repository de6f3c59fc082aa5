// Machine vise, in the frame of its place: z = 0 on the table, x = 0 its middle, y = 0 the face of
// the fixed jaw (at the back); the work lies at y < 0 and the jaws are parallel to X.
// The file that includes this one sets the measures:
//   jaw_x    half width of the jaws          bed_z    slideway of the moving jaw
//   jaw_top  upper edge of the jaws          back, front   reach of the body in +Y and -Y
//   work_x, work_y, work_z   the raw block; the moving jaw is closed on work_y
//   work_bottom              its lower face, on parallels above the slideway
//   bolt_y   where the clamping ears are     bolt_x   their T-bolts at x = +- this

// Body with slideway, clamping ears with T-bolts, the screw's bearing, parallels.
module vise_base() {
  difference() {
    union() {
      plate_at([-jaw_x - 3, -front, 0], [jaw_x + 3, back + 8, 24], 10, 2);
      block_at([-jaw_x + 9, -front + 4, 22], [jaw_x - 9, back + 4, bed_z], 3);
      block_at([-30, -front - 12, 16], [30, -front + 14, bed_z - 4], 4);
      plate_at([-bolt_x - 20, bolt_y - 30, 0], [bolt_x + 20, bolt_y + 30, 22], 12, 2);
    }
    block_at([-19, -front + 18, 26], [19, -8, bed_z + 10], 2);
    translate([0, -front - 20, screw_z]) rotate([-90, 0, 0]) cylinder(r = 13, h = 60, $fn = 28);
    for (s = [-1, 1]) hull() for (x = [bolt_x, bolt_x + 32])
      translate([s * x, bolt_y, -1]) cylinder(r = 8.5, h = 40, $fn = 24);
  }
  for (s = [-1, 1]) translate([s * bolt_x, bolt_y, 21.5]) {
    disc(15, 4, 0.8);
    translate([0, 0, 3.5]) disc(12, 11, 1, $fn = 6);
    cylinder(r = 6, h = 24, $fn = 20);
  }
  for (y = [-16, -work_y + 8]) block_at([-jaw_x + 5, y, bed_z - 0.5], [jaw_x - 5, y + 8, work_bottom - 0.5], 0.8);
}

// Fixed jaw with its hardened plate and two screws.
module vise_fixed_jaw() {
  z = (bed_z + jaw_top) / 2 + 1;
  difference() {
    union() {
      block_at([-jaw_x + 3, 9.5, bed_z - 1], [jaw_x - 3, back, jaw_top - 2], 6);
      block_at([-jaw_x, 0, bed_z + 1], [jaw_x, 11, jaw_top], 1);
    }
    for (x = [-38, 38]) translate([x, -1, z]) rotate([-90, 0, 0]) cylinder(r = 7, h = 6, $fn = 24);
  }
  for (x = [-38, 38]) translate([x, 8, z]) rotate([90, 0, 0]) disc(6, 6.5, 0.6, $fn = 20);
}

// Moving jaw: plate, carrier, and the nut below the slideway.
module vise_moving_jaw() {
  z = (bed_z + jaw_top) / 2 + 1;
  translate([0, -work_y, 0]) {
    difference() {
      union() {
        block_at([-jaw_x, -11, bed_z + 1], [jaw_x, -0.05, jaw_top], 1);
        hull() {
          block_at([-jaw_x + 3, -58, bed_z + 1], [jaw_x - 3, -9.5, bed_z + 18], 5);
          block_at([-jaw_x + 7, -42, bed_z + 1], [jaw_x - 7, -9.5, jaw_top - 2], 5);
        }
        block_at([-17, -54, 28], [17, -10, bed_z + 4], 2);
      }
      for (x = [-38, 38]) translate([x, 1, z]) rotate([90, 0, 0]) cylinder(r = 7, h = 6, $fn = 24);
    }
    for (x = [-38, 38]) translate([x, -8, z]) rotate([-90, 0, 0]) disc(6, 6.5, 0.6, $fn = 20);
  }
}

// Screw with its collar, square end, and the crank that is left on it.
module vise_screw() {
  y = -front - 42;
  translate([0, y, screw_z]) disc_y(11, front + 42 - work_y - 50, 1.5);
  translate([0, -front - 12.5, screw_z]) rotate([90, 0, 0]) disc(17, 14, 1.5);
  translate([0, y - 26, screw_z]) rotate([-90, 0, 0]) rotate([0, 0, 45]) disc(12, 30, 1, $fn = 4);
  hull() {
    translate([0, y - 14, screw_z]) rotate([90, 0, 0]) disc(14, 12, 2);
    translate([70, y - 14, screw_z - 16]) rotate([90, 0, 0]) disc(9, 12, 2);
  }
  translate([70, y - 20, screw_z - 16]) rotate([90, 0, 0])
    turned([[0, 0], [8, 0], [8, 8], [11, 20], [12, 50], [9, 66], [0, 68]]);
}

// The raw block that is clamped.
module vise_work() {
  block_at([-work_x / 2, -work_y + 0.1, work_bottom], [work_x / 2, -0.1, work_bottom + work_z], 1);
}
