// Measures of the vise on mill3 (their meaning: scad-lib/vise.scad).
include <../../scad-lib/solids.scad>
include <../../scad-lib/vise.scad>

jaw_x = 65;
bed_z = 62;
jaw_top = 104;
back = 60;
front = 250;
screw_z = 42;
bolt_x = 92;
bolt_y = -75;      // on the middle T-slot when the vise stands at y = 75 (fixtures/vise.toml)
work_x = 120;
work_y = 80;
work_z = 50;
work_bottom = 76;  // parallels of 14; the jaws hold 28 of the block
