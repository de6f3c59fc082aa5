// Lower X slide with the housing of the turret; behind it a tool for the second spindle.
include <params.scad>

mirror([0, 1, 0]) { cross_slide(gauge, pitch_r, inner); back_tool(gauge); }
