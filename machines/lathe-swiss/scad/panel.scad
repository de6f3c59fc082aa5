// Control panel.
include <params.scad>

translate([960, -330, 1330]) control_panel(360);
