// Disc turret with twelve stations; its driven one is on the gauge point.
include <params.scad>

translate([gauge, pitch_r, 0]) turret_disc();
