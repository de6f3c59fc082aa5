// Upper Z slide.
include <params.scad>

carriage(gauge, inner, 730, [200, 560]);
