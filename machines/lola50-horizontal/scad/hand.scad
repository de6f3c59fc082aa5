include <../../lola50-vertical/scad/hand.scad>
