// Control panel.
include <params.scad>

translate([1480, -560, 1250]) control_panel(700);
