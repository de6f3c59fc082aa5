// Left three-jaw chuck.
include <params.scad>

chuck();
