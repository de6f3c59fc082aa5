// Left headstock.
include <params.scad>

mirror([0, 1, 0]) headstock(-520, -130);
