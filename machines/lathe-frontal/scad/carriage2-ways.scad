// Right half: rails of the X slide.
include <params.scad>

carriage_ways(gauge);
