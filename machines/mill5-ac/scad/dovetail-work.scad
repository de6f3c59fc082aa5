// Raw part: a block of 60 x 60 x 60 with a dovetail below. Only for pictures.
include <params.scad>


profile_xz([[-16.5, 74.5], [16.5, 74.5], [21.5, 80.5], [-21.5, 80.5]], -24, 24);
block_at([-30, -30, 80.4], [30, 30, 140], 0.6);

