// lathe-frontal: measures. Frame of the units: scad-lib/lathe.scad; world: X right, the spindles
// look at the operator (-Y), Z up.
include <../../scad-lib/lathe.scad>

axis_z = 1100;   // spindles above the floor, at x = -240 and 240
gauge = 370;     // gauge points in front of the chucks' faces, Z slides at zero (machine.toml: -300 .. 0)
