// Bed casting, tilted back by 45 degrees; slides above and below the spindle.
include <params.scad>

slant_base(-560, 1200, tilt, axis_z, -620, 620, -420, 860);
