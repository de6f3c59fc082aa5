// Left turret housing, which swivels.
include <params.scad>

swivel_turret(gauge);
