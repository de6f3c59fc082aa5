include <vise-params.scad>

vise_fixed_jaw();
