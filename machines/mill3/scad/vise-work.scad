include <vise-params.scad>

vise_work();
