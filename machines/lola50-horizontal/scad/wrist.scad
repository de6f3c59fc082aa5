include <../../lola50-vertical/scad/wrist.scad>
