// Tailstock, parked behind the travel of the turret.
include <params.scad>

translate([1065, 0, 0]) tailstock();
