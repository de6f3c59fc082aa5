// Spindle on the flange; joint 6 turns it below the hand.
include <../../lola50-vertical/scad/params.scad>

in_bed() spindle_body(dt + 22);
