// Table in front of the robot, clamping face at z = -250, and its legs.
include <params.scad>

difference() {
  block_at([-500, -1500, -330], [500, -900, -250], 4);
  for (y = [-1400, -1300, -1200, -1100, -1000]) t_slot(-510, 510, y, -250, 14, 24);
}
for (x = [-440, 440], y = [-1440, -960]) block_at([x - 50, y - 50, floor_z], [x + 50, y + 50, -329], 4);
block_at([-440, -980, -520], [440, -940, -460], 3);
