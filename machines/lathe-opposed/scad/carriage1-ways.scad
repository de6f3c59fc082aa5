// Rails of the upper X slide.
include <params.scad>

carriage_ways(gauge, inner, 730);
