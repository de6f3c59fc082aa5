// Bed: a flat casting with a chip chute between the halves.
include <params.scad>

difference() {
  union() {
    taper([-900, -900, 900, 640], 40, [-880, -870, 880, 620], 400, 30);
    taper([-880, -870, 880, 620], 399.5, [-850, -830, 850, 600], axis_z + way, 20);
  }
  profile_xz([[-230, axis_z + way + 10], [-120, 300], [120, 300], [230, axis_z + way + 10]], -1000, -60);
  for (s = [0, 1]) mirror([s, 0, 0]) for (y = [-760, -420, -80, 260]) block_at([840, y, 160], [940, y + 240, 620], 20);
}
for (x = [-820, 820], y = [-780, 0, 560]) translate([x, y, 0]) { disc(52, 18, 3); translate([0, 0, 16]) cylinder(r = 18, h = 40, $fn = 20); }
