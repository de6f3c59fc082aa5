// Chip tray and splash guards: a sheet box around the base, open to the front and above.
include <params.scad>

module shell(o) {
  // outline of the guards, o inwards; high at the back and at the sides, low in front
  profile_yz([[-690 + o, 330 + o], [-690 + o, 545 + (o > 0 ? 40 : 0)], [-640 + o, 545 + (o > 0 ? 40 : 0)],
              [-470 + o, 900 + (o > 0 ? 40 : 0)], [430 - o, 900 + (o > 0 ? 40 : 0)], [430 - o, 330 + o]],
             -720 + o, 720 - o);
}
difference() {
  shell(0);
  shell(4);
  // the back is open where base and column stand
  block_at([-440, 380, 100], [440, 500, 1000], 2);
  block_at([-720 + 4, -700, 546], [720 - 4, -400, 1000], 0.5);
}
// rim of the front and two kick plates
block_at([-724, -694, 536], [724, -682, 552], 2);
for (s = [0, 1]) mirror([s, 0, 0]) block_at([560, -686, 20], [716, -640, 334], 4);
for (s = [0, 1]) mirror([s, 0, 0]) block_at([560, 340, 20], [716, 426, 334], 4);
