include <params.scad>

in_bed() base_body();
