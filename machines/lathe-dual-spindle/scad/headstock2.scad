// Right headstock.
include <params.scad>

mirror([1, 0, 0]) headstock(-520, -130);
