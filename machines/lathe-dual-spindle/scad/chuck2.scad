// Right three-jaw chuck.
include <params.scad>

mirror([1, 0, 0]) chuck();
