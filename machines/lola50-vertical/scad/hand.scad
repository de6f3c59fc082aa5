// Joint 6 is blocked: the hand's cone carries the flange.
include <params.scad>

in_bed() hand_body();
