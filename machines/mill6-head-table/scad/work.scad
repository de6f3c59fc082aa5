// Raw part: a frustum on a plate. Only for pictures.
include <params.scad>

plate_at([-180, -180, 600], [180, 180, 640], 10, 2);
translate([0, 0, 639]) turned([[0, 0], [150, 0], [95, 160], [0, 160]], $fn = 96);
