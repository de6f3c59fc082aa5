// Rails of the three Z slides.
include <params.scad>

ways(40, 1320, [200, 560]);
mirror([0, 1, 0]) ways(40, 1320, [200, 560]);
ways(700, 2020, [-70, 70]);
