// mill-turn: measures. Frame of the meshes but base, guard and panel: x along the spindle out of its chuck, y away from
// the operator, z up, origin in the middle of the chuck's face, 1000 above the floor.
include <../../scad-lib/lathe.scad>

axis_z = 1000;   // spindle above the floor
gauge = 870;     // gauge point in front of the chuck's face with Z at zero
