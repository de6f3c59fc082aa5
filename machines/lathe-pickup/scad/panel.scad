// Control panel.
include <params.scad>

translate([560, -420, 1250]) control_panel(560);
block_at([420, 140, 1200], [600, 220, 1420], 6);
