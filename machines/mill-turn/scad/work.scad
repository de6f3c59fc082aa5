// Bar in the chuck. Only for pictures.
include <params.scad>

bar(44.6, 170, -60);
