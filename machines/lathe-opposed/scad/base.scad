// Bed casting, tilted back by 45 degrees.
include <params.scad>

slant_base(-560, 2060, tilt, axis_z, -740, 740, -560, 1010);
