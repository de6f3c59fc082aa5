// Lower disc turret.
include <params.scad>

mirror([0, 1, 0]) translate([gauge, pitch_r, 0]) turret_disc();
