// Control panel.
include <params.scad>

translate([2880, -420, 1300]) control_panel(700);
