include <vise-params.scad>

vise_base();
