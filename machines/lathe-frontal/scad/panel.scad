// Control panel.
include <params.scad>

translate([1160, -300, 1330]) control_panel(420);
