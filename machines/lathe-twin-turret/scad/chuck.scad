// Three-jaw chuck of 210.
include <params.scad>

chuck();
