// Every kinematics type has one row: how it is made from the `[kinematics]` table of a
// machine.toml.
#pragma once

#include <span>
#include <string_view>

#include "machine/machine.h"

namespace aircut::machine {

/// What a row is made from. Parameters are read from `table`, so unknown ones are found.
struct KinematicsInput {
  config::Table& table;
  double unit_mm;                 ///< length unit of the file
  std::span<const Joint> driven;  ///< driven joints in log order; limits and parents may be unset
  const Machine& machine;         ///< its links, couples, work and spindle are read already
};

struct KinematicsRow {
  std::string_view type;
  /// Null when something is wrong; then the table has the errors.
  std::shared_ptr<const Kinematics> (*make)(KinematicsInput& input);
  /// Do X Y Z follow the work through rotary joints? If not (a control without TCP), tree and
  /// kinematics are compared with the rotary joints at zero only.
  bool follows_rotary;
};

std::span<const KinematicsRow> kinematics_table();

// One per file of this folder.
std::shared_ptr<const Kinematics> read_chain(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_identity(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_ox_glide(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_horizontal(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_vertical(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_6r(KinematicsInput& input);

/// A length in mm from the table, within ±1 km; errors go to the table.
double length(config::Table& table, const std::string& key, double fallback, double unit_mm);
/// A point in mm.
Vec3 point(config::Table& table, const std::string& key, const Vec3& fallback, double unit_mm);

}  // namespace aircut::machine
