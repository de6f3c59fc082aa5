// Left half: rails of the Z slide.
include <params.scad>

ways(40, 1005);
