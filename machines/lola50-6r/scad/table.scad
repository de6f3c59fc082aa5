include <../../lola50-vertical/scad/table.scad>
