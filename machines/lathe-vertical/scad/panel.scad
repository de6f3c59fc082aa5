// Control panel on a post.
include <params.scad>

translate([-760, -420, 900]) { control_panel(40); }
translate([-760, -340, -450]) disc(32, 1430, 4);
translate([-760, -340, -450]) disc(150, 20, 4);
