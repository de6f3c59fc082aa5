// Right headstock.
include <params.scad>

headstock(-520, -130);
