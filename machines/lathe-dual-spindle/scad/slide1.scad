// Left X slide with the seat of the turret.
include <params.scad>

swivel_seat(gauge);
