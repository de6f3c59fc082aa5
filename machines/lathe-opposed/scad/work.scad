// Bar in the main chuck. Only for pictures.
include <params.scad>

bar();
