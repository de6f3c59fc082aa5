#include "machine/kinematics/kinematics_table.h"

#include <cmath>
#include <vector>

namespace aircut::machine {

std::span<const KinematicsRow> kinematics_table() {
  static const std::vector<KinematicsRow> rows = [] {
    std::vector<KinematicsRow> all = {
        // type, reader, follows rotary joints, driven axes
        {"identity", read_identity, false, "", identity_joints},
        {"chain", read_chain, true, "", nullptr},
        {"ox-glide", read_ox_glide, true, "S1 S2 S3", nullptr},
        {"robot-horizontal", read_robot_horizontal, true, "J1* J2* J3* J4* J5*", nullptr},
        {"robot-vertical", read_robot_vertical, true, "J1* J2* J3* J4* J5*", nullptr},
        {"robot-6r", read_robot_6r, true, "J1* J2* J3* J4* J5* J6*", nullptr},
        {"calibrated", read_calibrated, true, "X Y Z", nullptr},
        {"corexy", read_corexy, true, "Q1 Q2 Q3", nullptr},
        {"gantry", read_gantry, true, "Q1 Q2 Q3 Q4", nullptr},
        {"polar", read_polar, true, "R Z C*", nullptr},
        {"rotated-xy", read_rotated_xy, true, "X Y Z C*", nullptr},
        {"plotter", read_plotter, true, "Q1 Q2 Z", nullptr},
        {"biglide", read_biglide, true, "S1 S2 Y", nullptr},
        {"five-bar", read_five_bar, true, "J1* J2* Z", nullptr},
        {"tripod", read_tripod, true, "Q1 Q2 Q3", nullptr},
        {"tripod-inverted", read_tripod_inverted, true, "Q1 Q2 Q3 A* B* C*", nullptr},
        {"triglide", read_triglide, true, "S1 S2 S3", nullptr},
        {"delta-linear", read_delta_linear, true, "S1 S2 S3", nullptr},
        {"delta-rotary", read_delta_rotary, true, "J1* J2* J3*", nullptr},
        {"hexapod", read_hexapod, true, "Q1 Q2 Q3 Q4 Q5 Q6", nullptr},
        {"hexaglide", read_hexaglide, true, "S1 S2 S3 S4 S5 S6", nullptr},
        {"pentapod", read_pentapod, true, "Q1 Q2 Q3 Q4 Q5", nullptr},
        {"scara", read_scara, true, "J1* J2* Z J4*", nullptr},
        {"scorbot", read_scorbot, true, "J1* J2* J3* J4* J5*", nullptr},
        {"puma", read_puma, true, "J1* J2* J3* J4* J5* J6*", nullptr},
        {"three21", read_three21, true, "J1* J2* J3* J4* J5* J6*", nullptr},
        {"lathe-vertical", read_lathe_vertical, true, "X Z C*", nullptr},
        {"serial", read_serial, true, "", serial_joints},
    };
    const auto presets = preset_rows();
    all.insert(all.end(), presets.begin(), presets.end());
    return all;
  }();
  return rows;
}

namespace {

// No machine tool is larger; beyond it a length is a mistake of units.
constexpr double largest_mm = 1e6;

bool in_range(config::Table& table, const std::string& key, double mm) {
  if (std::abs(mm) <= largest_mm) return true;
  table.error(key, "'" + key + "' is " + shortest(mm) + " mm; lengths go up to 1 km");
  return false;
}

}  // namespace

double length(config::Table& table, const std::string& key, double fallback, double unit_mm) {
  const auto value = table.number(key);
  if (!value || !in_range(table, key, *value * unit_mm)) return fallback;
  return *value * unit_mm;
}

Vec3 point(config::Table& table, const std::string& key, const Vec3& fallback, double unit_mm) {
  const auto values = table.numbers(key, 3);
  if (!values) return fallback;
  for (const double value : *values)
    if (!in_range(table, key, value * unit_mm)) return fallback;
  return Vec3((*values)[0], (*values)[1], (*values)[2]) * unit_mm;
}

}  // namespace aircut::machine
