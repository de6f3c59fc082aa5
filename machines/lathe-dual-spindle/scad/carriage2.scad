// Right Z slide.
include <params.scad>

mirror([1, 0, 0]) carriage(gauge);
