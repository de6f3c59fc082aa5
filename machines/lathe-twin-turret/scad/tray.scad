// Chip tray and splash guards.
include <params.scad>

tray(-640, 1280, -740, 960, 620, 1700);
