// Bed: pedestal of the table and the beam of the columns.
include <params.scad>

translate([0, 0, -420]) disc(470, 330, 20, $fn = 72);
translate([0, 0, -95]) turned([[0, 0], [440, 0], [440, 160], [410, 220], [380, 300], [0, 300]], $fn = 72);
block_at([-400, 250, -420], [1120, 840, -92], 20);
block_at([-330, 425, -95], [1060, 820, -40], 8);
for (x = [-340, 360, 1060], y = [320, 780]) translate([x, y, -450]) disc(52, 32, 3);
for (k = [0:4]) rotate([0, 0, 200 + k * 35]) translate([400, 0, -450]) disc(45, 32, 3);
