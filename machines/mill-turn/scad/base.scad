// Bed casting.
include <params.scad>

slant_base(-620, 1560, 0, axis_z, -300, 1180, -480, 1260);
