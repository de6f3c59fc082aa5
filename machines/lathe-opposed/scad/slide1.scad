// Upper X slide with the bearing of the milling head.
include <params.scad>

head_bearing(gauge);
