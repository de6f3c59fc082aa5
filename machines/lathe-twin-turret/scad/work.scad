// Bar in the chuck. Only for pictures.
include <params.scad>

bar();
