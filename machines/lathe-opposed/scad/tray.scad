// Chip tray and splash guards.
include <params.scad>

tray(-640, 2140, -880, 1110, 640, 2000);
