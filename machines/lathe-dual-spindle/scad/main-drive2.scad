// Right main motor and the guard of its belt.
include <params.scad>

mirror([1, 0, 0]) main_drive(-500, -180);
