// Rod 2: from slider 2 to the right joint of the platform, drawn hanging from (0, +d).
include <rod-params.scad>

translate([0, rod_in, d]) rod(l2, 23, 13, 30, rod_out - rod_in);
