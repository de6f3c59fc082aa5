// lathe-opposed: measures. Frame of the units: scad-lib/lathe.scad; world: X along the spindles, Z up.
include <../../scad-lib/lathe.scad>

tilt = 45;      // of the bed
axis_z = 1250;  // spindles above the floor
gauge = 870;    // gauge points in front of the main chuck's face, Z slides at zero (machine.toml: -800 .. 0)
sub_x = 1500;   // face of the second chuck, Z3 at zero (-900 .. 0)
inner = 150;    // the carriages keep this far from the middle, where the second spindle travels
