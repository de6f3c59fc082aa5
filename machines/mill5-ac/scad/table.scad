// The same casting as on mill3.
include <../../mill3/scad/table.scad>
