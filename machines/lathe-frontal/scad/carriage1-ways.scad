// Left half: rails of the X slide.
include <params.scad>

mirror([0, 1, 0]) carriage_ways(gauge);
