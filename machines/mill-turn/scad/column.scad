// Column: slide of Z.
include <params.scad>

difference() {
  union() {
    block_at([gauge - 110, 500, way + 30], [gauge + 390, 1130, way + 120], 10);
    for (y = [560, 1060], x = [gauge - 100, gauge + 250]) block_at([x, y - 46, way + 5], [x + 130, y + 46, way + 40], 4);
    hull() {
      block_at([gauge - 90, 640, way + 110], [gauge + 370, 1110, way + 150], 10);
      block_at([gauge - 90, 640, 1040], [gauge + 370, 880, 1080], 10);
    }
  }
  for (x = [gauge - 120, gauge + 330], z = [0, 420]) block_at([x, 720, z - 120], [x + 70, 860, z + 180], 24);
}
for (x = [gauge - 50, gauge + 330]) translate([x, 641, way + 130]) rotate([0, -90, 90]) rail_x(1180, 40, 30, 200);
translate([gauge + 140, 760, 1075]) motor(130, 200);
