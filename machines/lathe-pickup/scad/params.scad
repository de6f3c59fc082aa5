// lathe-pickup: measures. World: X along the beam, Y away from the operator, Z up from the floor; the driven
// station of the turret is at x = 0, y = 0.
include <../../scad-lib/lathe.scad>

gauge_z = 950;   // gauge point of the fixed turret
face_z = 1510;   // chuck's face with Z at zero
axis_x = 20;     // spindle's axis with X at zero
