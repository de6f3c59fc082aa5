// Three-jaw chuck of the second spindle.
include <params.scad>

translate([sub_x, 0, 0]) mirror([1, 0, 0]) chuck(80, 95, 30, 38);
