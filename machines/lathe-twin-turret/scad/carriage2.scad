// Lower Z slide, the mirror image of the upper one.
include <params.scad>

mirror([0, 1, 0]) carriage(gauge);
