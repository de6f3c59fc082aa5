// lathe-slant: measures. Frame of the unit: scad-lib/lathe.scad; world: X along the spindle, Z up.
include <../../scad-lib/lathe.scad>

tilt = 45;      // of the bed
axis_z = 1050;  // spindle above the floor
gauge = 670;    // gauge point in front of the chuck's face, Z slide at zero (machine.toml: -600 .. 50)
