include <params.scad>

in_bed() wrist_body();
