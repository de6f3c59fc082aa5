// Left half: rails of the Z slide.
include <params.scad>

mirror([0, 1, 0]) ways(40, 830);
