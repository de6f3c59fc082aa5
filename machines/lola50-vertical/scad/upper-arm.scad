include <params.scad>

in_bed() upper_arm_body();
