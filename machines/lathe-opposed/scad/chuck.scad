// Three-jaw chuck of the main spindle.
include <params.scad>

chuck();
