// Three-jaw chuck of 210, looking down.
include <params.scad>

translate([axis_x, 0, face_z]) rotate([0, 90, 0]) chuck(grip = 50);
