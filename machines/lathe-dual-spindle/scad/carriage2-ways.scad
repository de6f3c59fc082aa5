// Right half: rails of the X slide.
include <params.scad>

mirror([1, 0, 0]) carriage_ways(gauge);
