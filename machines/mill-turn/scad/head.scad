// Milling and turning head, swivelled by B.
include <params.scad>

milling_head(gauge);
