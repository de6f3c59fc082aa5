include <../../lola50-vertical/scad/upper-arm.scad>
