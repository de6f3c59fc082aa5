// Cradle: two cheeks with the shafts of A, a bridge under the turntable with the drive of C inside.
include <params.scad>

difference() {
  union() {
    for (s = [-1, 1]) {
      profile_yz([[-60, a_z + 26], [60, a_z + 26], [74, a_z - 10], [74, c_face - 84], [52, c_face - 118], [-52, c_face - 118],
                  [-74, c_face - 84], [-74, a_z - 10]],
                 s > 0 ? cradle_x - 40 : -cradle_x, s > 0 ? cradle_x : -cradle_x + 40);
      translate([s > 0 ? cradle_x - 10 : -cradle_x - 74, 0, a_z]) disc_x(32, 84, 2);
    }
    profile_yz([[-104, c_face - 58], [104, c_face - 58], [110, c_face - 66], [96, c_face - 104], [60, c_face - 124],
                [-60, c_face - 124], [-96, c_face - 104], [-110, c_face - 66]], -cradle_x + 2, cradle_x - 2);
    translate([0, 0, c_face - 60]) disc(104, 22, 4, $fn = 72);
  }
  // lightening of the cheeks, seen from the sides
  for (s = [-1, 1]) translate([s * (cradle_x + 2), 0, 0]) rotate([0, 90, 0]) linear_extrude(height = 24, center = true)
    soft(8) polygon([[-c_face + 40, -44], [-c_face + 40, 44], [-c_face + 96, 36], [-c_face + 96, -36]]);
}
