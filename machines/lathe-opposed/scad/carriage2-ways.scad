// Rails of the lower X slide.
include <params.scad>

mirror([0, 1, 0]) carriage_ways(gauge, inner, 730);
