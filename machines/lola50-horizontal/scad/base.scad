include <../../lola50-vertical/scad/base.scad>
