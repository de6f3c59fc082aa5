// Measures of the vise on ox-glide-crossed (their meaning: scad-lib/vise.scad).
include <../../scad-lib/solids.scad>
include <../../scad-lib/vise.scad>

jaw_x = 55;
bed_z = 50;
jaw_top = 88;
back = 40;
front = 170;
screw_z = 36;
bolt_x = 80;
bolt_y = -45;
work_x = 150;
work_y = 90;
work_z = 50;
work_bottom = 75;  // parallels of 25; the jaws hold 13 of the block
