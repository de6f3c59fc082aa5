// Right turret housing, which swivels.
include <params.scad>

mirror([1, 0, 0]) swivel_turret(gauge);
