// Rails of the Z slide, and the lower one of the tailstock.
include <params.scad>

{ ways(40, 1460); ways(760, 1460, [-90]); }
