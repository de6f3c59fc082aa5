// Left Z slide.
include <params.scad>

mirror([0, 1, 0]) carriage(gauge);
