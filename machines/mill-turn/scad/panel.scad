// Control panel.
include <params.scad>

translate([1820, -360, 1280]) control_panel(560);
