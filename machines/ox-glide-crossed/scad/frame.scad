// Frame: base block with a chip chute and two walls with windows; the Y rails lie on the walls.
include <params.scad>

difference() {
  union() {
    translate([x_mid, 0, 0]) {
      taper([-wall_out - 25, -430, wall_out + 25, 455], floor_z + 50, [-wall_out, -400, wall_out, 435], -640, 24);
      for (s = [0, 1]) mirror([s, 0, 0]) hull() {
        block_at([wall_in - 30, -375, -650], [wall_out, 425, -640], 3);
        block_at([wall_in, -350, -560], [wall_out, 415, -550], 3);
      }
      for (s = [0, 1]) mirror([s, 0, 0]) block_at([wall_in, -350, -560], [wall_out, 415, wall_top], 8);
      // cross member, behind what the platform reaches at Y 150
      block_at([-wall_in - 10, 362, -420], [wall_in + 10, 412, -250], 8);
    }
  }
  // windows of the walls, drawn as a truss
  for (s = [0, 1]) translate([x_mid, 0, 0]) mirror([s, 0, 0]) translate([wall_in - 40, 0, 0]) rotate([90, 0, 90])
    linear_extrude(height = 200) soft(20) {
      polygon([[-280, -500], [-20, -500], [-280, -100]]);
      polygon([[20, -500], [280, -500], [280, -100]]);
      polygon([[0, -470], [270, -60], [-270, -60]]);
      translate([-275, -20]) square([250, 100]);
      translate([25, -20]) square([250, 100]);
    }
  // chip chute in front of the table and shallow panels on the base
  translate([x_mid, 0, 0]) profile_yz([[-500, -600], [-500, -790], [-430, -790], [-215, -690], [-215, -600]], -380, 380);
  for (s = [0, 1]) translate([x_mid, 0, 0]) mirror([s, 0, 0]) for (y = [-330, -90, 150])
    translate([wall_out - 14, y, -830]) rotate([90, 0, 90]) linear_extrude(height = 80) soft(16) square([200, 150]);
}
// levelling feet
for (x = [x_mid - 520, x_mid + 520], y = [-360, 330]) translate([x, y, floor_z]) {
  disc(55, 20, 3);
  translate([0, 0, 19]) cylinder(r = 18, h = 34, $fn = 20);
}
// stops at the ends of the Y rails
for (s = [-1, 1], y = [-349, 331]) translate([x_mid + s * 540, y, wall_top - 1]) block_at([-22, 0, 0], [22, 18, 44], 3);
