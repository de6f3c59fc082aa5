// Disc in the right chuck. Only for pictures.
include <params.scad>

bar(39.6, 90, 5);
