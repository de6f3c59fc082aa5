// lathe-dual-spindle: measures. Frame of the units: scad-lib/lathe.scad; world: X along the spindles, Z up.
// The right half is the mirror image of the left one; its chuck looks back from x = 2040.
include <../../scad-lib/lathe.scad>

tilt = 45;      // of the bed
axis_z = 1050;  // spindles above the floor
gauge = 570;    // gauge points in front of the chucks' faces, Z slides at zero (machine.toml: -500 .. 0)
