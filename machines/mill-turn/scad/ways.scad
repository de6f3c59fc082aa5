// Rails of the column.
include <params.scad>

ways(-160, 1500, [560, 1060]);
