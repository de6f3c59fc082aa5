include <../../lola50-vertical/scad/turret.scad>
