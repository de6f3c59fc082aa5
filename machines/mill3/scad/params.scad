// mill3: measures of the machine. Bed axes with every joint at zero: X right, Y away from the
// operator, Z up; z = 0 is the floor, x = 0 the middle of the table, y = 0 the spindle axis.
include <../../scad-lib/solids.scad>

// travel (machine.toml holds the same numbers)
x_travel = 250;   // X joint: -250 .. 250
y_travel = 200;   // Y joint: -200 .. 200
z_travel = 400;   // Z joint: -400 .. 0

table_top = 830;
nose_z = 1380;    // gauge face with Z at 0: 550 above the table
table_x = 360;    // half length
table_y = 210;    // half width
column_y = 470;   // front face of the column: table_y + y_travel + 60

way_z = 560;      // top of the base, where the Y rails sit
y_rail_x = 210;   // Y rails at x = +- this
x_rail_y = 150;   // X rails at y = +- this
x_rail_z = 690;   // top of the saddle casting
z_rail_x = 170;   // Z rails at x = +- this
