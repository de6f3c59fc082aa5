// Right three-jaw chuck, closed on 80.
include <params.scad>

chuck(grip = 40);
