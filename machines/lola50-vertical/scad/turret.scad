include <params.scad>

in_bed() turret_body();
