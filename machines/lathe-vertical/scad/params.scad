// lathe-vertical: measures. World: X along the cross rail, Z up, z = 0 the foot of the columns; floor -450.
include <../../scad-lib/lathe.scad>

chuck_z = 350;   // d0: face of the table
work_z = 410;    // d0 + dw: zero of the work
rail_z = 1150;   // b0 + b3: face of the ram with Z at zero, without the tool's length lt
gauge_x = 365;   // b2 + at: gauge point with X at zero
gauge_z = 1010;  // rail_z - lt
