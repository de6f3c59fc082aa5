// Rails of both Z slides.
include <params.scad>

ways(40, 1180); ways(40, 1180, [-400, -70]);
