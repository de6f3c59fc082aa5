// Left X slide with the housing of the turret.
include <params.scad>

mirror([0, 1, 0]) cross_slide(gauge);
