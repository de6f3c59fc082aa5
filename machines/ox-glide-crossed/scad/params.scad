// ox-glide-crossed: measures of the machine. Bed axes {O}: X along the guides, Y the carriage's way,
// Z up; the guides are at z = -d and z = +d, so the floor is at z = floor_z. Every mesh is drawn
// with all joints and passive values at zero: both sliders at x = 0, the rods hanging straight
// down, the platform point P at the origin.
include <../../scad-lib/solids.scad>

// the mechanism (machine.toml holds the same numbers)
l1 = 302;    // rod 1, on the lower guide
l2 = 432;    // rod 2, on the upper guide
p1 = 55;     // rod 1's joint on the platform is at x - p1
p2 = 65;     // rod 2's joint at x + p2
d = 74;      // height of the guides above and below z = 0
stroke = 500;
y_stroke = 150;
par = [-30, 60];  // from a joint of rod 1 to the same joint of its parallel link, in X and Z

// planes across Y, front = -Y: beams inside, sliders on their outer faces, rods outermost
beam_in = 70;
beam_out = 110;
slider_in = 114;
slider_out = 150;
rod_in = 160;
rod_out = 180;

x_mid = 250;
floor_z = -900;
table_z = -560;   // clamping face
wall_in = 495;    // the frame's walls stand from x_mid +- wall_in to x_mid +- wall_out
wall_out = 585;
wall_top = 130;
end_in = 370;     // end plates of the carriage
end_out = 400;
