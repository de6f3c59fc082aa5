// Ram: slide of Z; its lower face is the mount of the head.
include <params.scad>

difference() {
  block_at([-158, -158, mount], [158, 158, mount + 1500], 8);
  for (s = [0, 1]) mirror([s, 0, 0]) block_at([152, -40, mount + 160], [170, 40, mount + 1400], 3);
}
translate([0, 0, mount + 1495]) motor(170, 230);
