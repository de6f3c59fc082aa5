// Headstock.
include <params.scad>

headstock(-560, -130);
