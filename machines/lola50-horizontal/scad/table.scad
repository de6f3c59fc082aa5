// Angle plate in front of the robot; its face, with T-slots, is at y = -1400 of the bed.
include <../../lola50-vertical/scad/params.scad>

difference() {
  block_at([-450, -1480, floor_z], [450, -1400, 750], 4);
  for (z = [100, 250, 400, 550, 700]) translate([0, -1400, z]) rotate([-90, 0, 0]) t_slot(-460, 460, 0, 0, 14, 24);
}
for (x = [-380, 0, 380]) hull() {
  block_at([x - 20, -1490, floor_z], [x + 20, -1475, 600], 2);
  block_at([x - 20, -1900, floor_z], [x + 20, -1475, floor_z + 40], 2);
}
