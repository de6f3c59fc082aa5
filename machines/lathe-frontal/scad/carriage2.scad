// Right Z slide.
include <params.scad>

carriage(gauge);
