// Disc in the chuck. Only for pictures.
include <params.scad>

translate([axis_x, 0, face_z - 50]) disc(49.6, 45, 1, $fn = 64);
