// Main motor and the guard of its belt.
include <params.scad>

main_drive(-540, -220);
