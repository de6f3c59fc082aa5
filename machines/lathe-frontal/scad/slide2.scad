// Right X slide with the housing of the turret.
include <params.scad>

cross_slide(gauge);
