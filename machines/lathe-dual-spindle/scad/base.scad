// Bed casting, tilted back by 45 degrees.
include <params.scad>

slant_base(-560, 2600, tilt, axis_z, -230, 600);
