// Control panel on a post.
include <params.scad>

translate([-1250, -1150, 1280]) control_panel(40);
translate([-1250, -1070, 0]) disc(36, 1340, 4);
translate([-1250, -1070, 0]) disc(170, 24, 4);
