// Milling head, swivelled by A.
include <params.scad>

milling_head(gauge);
