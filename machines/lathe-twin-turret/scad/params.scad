// lathe-twin-turret: measures. Frame of the units: scad-lib/lathe.scad; world: X along the spindle, Z up.
include <../../scad-lib/lathe.scad>

tilt = 45;      // of the bed
axis_z = 1150;  // spindle above the floor
gauge = 670;    // gauge points in front of the chuck's face, Z slides at zero (machine.toml: -600 .. 0)
