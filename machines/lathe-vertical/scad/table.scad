// Rotary table with T-slots; its jaws hold a ring from inside.
include <params.scad>

difference() {
  translate([0, 0, chuck_z - 132]) turned([[0, 0], [340, 0], [370, 30], [398, 40], [400, 42], [400, 130], [398, 132], [0, 132]], $fn = 96);
  for (k = [0:7]) rotate([0, 0, k * 45 + 22.5]) translate([190, -11, chuck_z - 20]) cube([220, 22, 30]);
  translate([0, 0, chuck_z - 60]) cylinder(r = 45, h = 80, $fn = 40);
}
for (k = [0:3]) rotate([0, 0, k * 90])
  profile_xz([[50, chuck_z - 5], [170, chuck_z - 5], [170, chuck_z + 14], [98, chuck_z + 14], [98, chuck_z + 44], [62, chuck_z + 44], [50, chuck_z + 24]], -24, 24);
