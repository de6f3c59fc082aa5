// Rod 1: from slider 1 to the left joint of the platform, drawn hanging from (0, -d).
include <rod-params.scad>

translate([0, -rod_out, -d]) rod(l1, 21, 12, 26, rod_out - rod_in);
