// Block on the table, only drawn.
include <params.scad>

block_at([-150, -1300, -249.9], [150, -1100, -150], 2);
