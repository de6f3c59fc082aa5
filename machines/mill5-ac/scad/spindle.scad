// The same casting as on mill3.
include <../../mill3/scad/spindle.scad>
