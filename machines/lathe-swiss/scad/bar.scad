// Bar that runs through the guide bush. Only for pictures.
include <params.scad>

translate([-300, 0, 0]) disc_x(10, 340, 0.5, $fn = 40);
