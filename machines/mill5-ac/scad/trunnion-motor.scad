// Drive of A: gear box and motor on the right bracket.
include <params.scad>

translate([bracket_x + 85, 0, a_z]) rotate([0, 90, 0]) servo(92, 120);
