// Left three-jaw chuck, closed on 80.
include <params.scad>

mirror([0, 1, 0]) chuck(grip = 40);
