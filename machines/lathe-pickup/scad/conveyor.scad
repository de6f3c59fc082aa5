// Conveyor that brings the parts: the spindle picks them up.
include <params.scad>

block_at([-1000, -620, 820], [-760, 300, 868], 6);
for (y = [-560, 220]) block_at([-980, y, 560], [-780, y + 60, 825], 6);
for (x = [-1006, -762]) block_at([x, -620, 850], [x + 8, 300, 890], 2);
for (y = [-560, -420]) translate([-880, y, 866]) disc(49, 44, 1, $fn = 48);
block_at([-960, -560, 20], [-800, -480, 822], 6);
