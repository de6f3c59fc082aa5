// Table: fixed to the base, T-slots along X.
include <params.scad>

difference() {
  union() {
    plate_at([x_mid - 230, -190, table_z - 48], [x_mid + 230, 190, table_z], 10, 2);
    taper([x_mid - 190, -150, x_mid + 190, 170], -650, [x_mid - 175, -140, x_mid + 175, 160], table_z - 46, 14);
  }
  for (y = [-100, 0, 100]) t_slot(x_mid - 240, x_mid + 240, y, table_z, 12, 20, 11, 9);
}
