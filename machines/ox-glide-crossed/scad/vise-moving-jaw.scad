include <vise-params.scad>

vise_moving_jaw();
