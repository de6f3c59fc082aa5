// Second headstock on its slide; it looks at the first one.
include <params.scad>

translate([sub_x, 0, 0]) mirror([1, 0, 0]) headstock(-430, -130, 90, 110, way + 24);
