// Right disc turret.
include <params.scad>

mirror([1, 0, 0]) translate([gauge, pitch_r, 0]) turret_disc();
