include <../../lola50-vertical/scad/forearm.scad>
