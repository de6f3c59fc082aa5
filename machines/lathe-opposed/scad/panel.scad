// Control panel.
include <params.scad>

translate([2340, -640, 1250]) control_panel(800);
