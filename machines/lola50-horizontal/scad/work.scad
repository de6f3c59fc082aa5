// Block on the angle plate, only drawn.
include <../../lola50-vertical/scad/params.scad>

block_at([-100, -1399.9, 300], [100, -1300, 500], 2);
