// Ram: slide of Y, with the bearing of B.
include <params.scad>

block_at([gauge + 48, 150, -92], [gauge + 232, 515, 92], 6);
translate([gauge + 140, 96, 0]) disc_y(92, 70, 5, $fn = 48);
