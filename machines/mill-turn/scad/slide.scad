// Slide of X on the column, with the guide of the ram.
include <params.scad>

difference() {
  union() {
    block_at([gauge - 90, 560, -230], [gauge + 370, 606, 250], 8);
    block_at([gauge - 10, 330, -150], [gauge + 290, 570, 150], 14);
    for (x = [gauge - 92, gauge + 282], z = [-215, 145]) block_at([x, 596, z], [x + 90, 636, z + 90], 4);
  }
  block_at([gauge + 44, 300, -96], [gauge + 236, 620, 96], 2);
}
