// Right half: rails of the Z slide.
include <params.scad>

mirror([1, 0, 0]) ways(40, 1005);
