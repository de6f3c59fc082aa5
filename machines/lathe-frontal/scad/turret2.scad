// Right disc turret.
include <params.scad>

translate([gauge, pitch_r, 0]) turret_disc();
