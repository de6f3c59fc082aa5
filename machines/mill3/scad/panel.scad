// Operator panel on a swinging arm, left of the work space.
include <params.scad>

mirror([1, 0, 0]) translate([790, -560, 0]) {
  // post on the tray's side, arm, tilted box with screen, keys, and emergency stop
  translate([-40, 120, 300]) disc(26, 1160, 3);
  block_at([-71, 90, 320], [-12, 150, 400], 5);
  block_at([-71, 90, 760], [-12, 150, 840], 5);
  translate([-40, 120, 1420]) disc(36, 60, 4);
  block_at([-60, -60, 1430], [-20, 125, 1470], 5);
  translate([-40, -70, 1230]) rotate([12, 0, -18]) difference() {
    union() {
      block_at([-170, -40, -170], [170, 60, 250], 10);
      for (i = [0:7], j = [0:3]) block_at([-140 + 24 * i, -46, -130 + 26 * j], [-122 + 24 * i, -39, -112 + 26 * j], 1.5);
      translate([112, -39, -95]) rotate([90, 0, 0]) disc(26, 26, 4);
      translate([112, -39, -20]) rotate([90, 0, 0]) disc(20, 14, 2);
    }
    block_at([-145, -60, 20], [145, -34, 225], 1);
  }
}
