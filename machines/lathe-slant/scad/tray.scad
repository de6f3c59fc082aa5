// Chip tray and splash guards.
include <params.scad>

tray(-640, 1560, -560, 860, 700, 1520);
