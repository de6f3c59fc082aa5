// Disc in the left chuck. Only for pictures.
include <params.scad>

mirror([0, 1, 0]) bar(39.6, 90, 5);
