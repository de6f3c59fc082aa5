// Spindle on the flange, whose neck reaches up to the hand.
include <params.scad>

in_bed() spindle_body(dt + 33);
