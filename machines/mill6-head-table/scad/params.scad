// mill6-head-table: measures. World: X right, Y away from the operator, Z up from the floor; the axis of
// the turntable is x = 0, y = 0. Points of the head are those of HEAD_DEF (machine.toml).
include <../../scad-lib/lathe.scad>

mount = 2390.784;                 // ram's lower face with Z at zero
axis_a = [0.359, 200.039, 1850.296];   // second axis: mount + v1 + vh
face = [0.37, 199.998, 1600.247];     // gauge face: second axis + v2
