// mill5-ac: the frame of mill3 with a trunnion on its table. Bed axes with every joint at zero.
include <../../mill3/scad/params.scad>

a_z = 1010;       // axis of A: along X, at y = 0
c_face = 980;     // face of the turntable, 30 under the axis of A; its axis is x = 0, y = 0
c_radius = 110;   // turntable
bracket_x = 178;  // inner faces of the brackets at x = +- this
cradle_x = 168;   // cheeks of the cradle, 10 clear of the brackets
