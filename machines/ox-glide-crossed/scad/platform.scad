// Platform with P in the origin: cross plate below both guides, cheeks with the rods' joints, and
// the housing of the spindle, which rises between the beams.
include <params.scad>

cheek_in = 140;
cheek_out = 153;
module pin(x, z, r) {  // towards -Y
  translate([x, -cheek_out + 1, z]) rotate([90, 0, 0]) {
    disc(r + 6, rod_in - cheek_out, 0.8, $fn = 28);
    cylinder(r = r, h = rod_out - cheek_out + 3, $fn = 28);
    translate([0, 0, rod_out - cheek_out + 2]) disc(r + 6, 7, 1.5, $fn = 28);
    translate([0, 0, rod_out - cheek_out + 8.5]) disc(r * 0.7, 4, 0.8, $fn = 6);
  }
}
difference() {
  union() {
    // cross plate with ribs below
    plate_at([-100, -cheek_out, 16], [92, cheek_out, 40], 14, 2);
    for (x = [-62, 58]) block_at([x - 8, -cheek_out + 4, 2], [x + 8, cheek_out - 4, 18], 3);
    // spindle housing
    translate([0, 0, 8]) turned([[0, 0], [44, 0], [48, 4], [48, 30], [62, 32], [62, 50], [58, 54], [50, 56],
      [50, 128], [46, 132], [0, 132]], $fn = 56);
    // front cheek: rod 1 and its parallel link
    hull() {
      translate([-p1, -cheek_out, 0]) disc_y(24, cheek_out - cheek_in, 2);
      translate([-p1 + par[0], -cheek_out, par[1]]) disc_y(18, cheek_out - cheek_in, 2);
      block_at([-100, -cheek_out, 20], [-20, -cheek_in, 38], 2);
    }
    hull() {  // brace to the housing
      block_at([-96, -cheek_in - 2, 38], [-76, -cheek_in + 2, 66], 1);
      block_at([-96, -70, 36], [-76, -64, 40], 1);
    }
    // rear cheek: rod 2
    hull() {
      translate([p2, cheek_in, 0]) disc_y(26, cheek_out - cheek_in, 2);
      block_at([20, cheek_in, 18], [92, cheek_out, 38], 2);
    }
  }
  translate([0, 0, -1]) cylinder(r = 34, h = 300, $fn = 48);
}
pin(-p1, 0, 11);
pin(-p1 + par[0], par[1], 8);
mirror([0, 1, 0]) pin(p2, 0, 12);
