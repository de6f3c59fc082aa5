// Bracket below the flange that carries the motor spindle across the flange's axis; the gauge face is
// 250 in front of that axis.
include <../../lola50-vertical/scad/params.scad>

dt = 200;
at = 250;
in_bed() translate([d4, 0, a2 - d6 - dt]) {
  translate([at, 0, 0]) rotate([0, -90, 0]) difference() {
    turned([[0, 0], [24, 0], [28, 3], [28, 16], [44, 20], [50, 26], [50, 380], [40, 390], [0, 390]], $fn = 56);
    turned([[0, -1], [11.5, -1], [11.5, 0], [6.4, 35], [6.4, 60], [0, 60]], $fn = 40);
  }
  block_at([-75, -70, -65], [75, 70, 65], 8);
  translate([0, 0, 60]) cylinder(r = 48, h = 130, $fn = 48);
  translate([0, 0, dt - 15]) disc(70, 15, 2, $fn = 48);
  translate([0, 0, dt - 1]) cylinder(r = 38, h = 23, $fn = 48);
}
