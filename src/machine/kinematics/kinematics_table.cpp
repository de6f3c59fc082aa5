#include "machine/kinematics/kinematics_table.h"

#include <array>
#include <cmath>

namespace aircut::machine {

std::span<const KinematicsRow> kinematics_table() {
  static constexpr std::array<KinematicsRow, 6> rows = {{
      // type              reader                 follows rotary joints
      {"identity", read_identity, false},
      {"chain", read_chain, true},
      {"ox-glide", read_ox_glide, true},
      {"robot-horizontal", read_robot_horizontal, true},
      {"robot-vertical", read_robot_vertical, true},
      {"robot-6r", read_robot_6r, true},
  }};
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
