// Bar in the right chuck. Only for pictures.
include <params.scad>

mirror([1, 0, 0]) bar();
