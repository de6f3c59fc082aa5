include <vise-params.scad>

vise_screw();
