// Right X slide with the seat of the turret.
include <params.scad>

mirror([1, 0, 0]) swivel_seat(gauge);
