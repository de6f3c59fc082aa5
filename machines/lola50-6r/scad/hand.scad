// Hand on joint 5, with the bearing of joint 6 at its end.
include <../../lola50-vertical/scad/hand.scad>
