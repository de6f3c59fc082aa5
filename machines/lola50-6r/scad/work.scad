include <../../lola50-vertical/scad/work.scad>
