// Control panel.
include <params.scad>

translate([1760, -420, 1300]) control_panel(700);
