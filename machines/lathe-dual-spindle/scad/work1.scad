// Bar in the left chuck. Only for pictures.
include <params.scad>

bar();
