// Parallel link of rod 1: same length and direction, one step beside it. It keeps the platform from
// tilting.
include <rod-params.scad>

translate([par[0], -rod_out, -d + par[1]]) rod(l1, 16, 9, 18, rod_out - rod_in);
