// Chip tray and splash guards.
include <params.scad>

tray(-640, 2680, -560, 860, 700, 1520);
