// Three-jaw chuck of 250.
include <params.scad>

chuck(125, 105, 45, 46);
