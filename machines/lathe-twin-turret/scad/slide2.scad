// Lower X slide.
include <params.scad>

mirror([0, 1, 0]) cross_slide(gauge);
