include <params.scad>

in_bed() forearm_body();
