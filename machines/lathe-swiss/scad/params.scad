// lathe-swiss: measures. Frame of all meshes but base, guard and panel: scad-lib/lathe.scad on a flat bed, its
// x = 0 is the face of the guide bush; world: X along the spindles, Y away from the operator, Z up.
include <../../scad-lib/lathe.scad>

axis_z = 1000;   // spindles above the floor
top = -180;      // z of the bed's upper face
