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
  /// Names of the driven axes for the type without a package, those that turn with a star; empty:
  /// the type needs a package.
  std::string_view joints;
  /// Likewise where they depend on the parameters; null otherwise.
  std::string (*joints_of)(config::Table& table);
};

std::span<const KinematicsRow> kinematics_table();

// One per file of this folder.
std::shared_ptr<const Kinematics> read_chain(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_identity(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_ox_glide(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_horizontal(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_vertical(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_robot_6r(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_calibrated(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_corexy(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_gantry(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_polar(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_rotated_xy(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_plotter(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_biglide(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_five_bar(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_tripod(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_tripod_inverted(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_triglide(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_delta_linear(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_delta_rotary(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_hexapod(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_hexaglide(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_pentapod(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_scara(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_scorbot(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_puma(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_three21(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_lathe_vertical(KinematicsInput& input);
std::shared_ptr<const Kinematics> read_serial(KinematicsInput& input);
std::string identity_joints(config::Table& table);
std::string serial_joints(config::Table& table);
std::span<const KinematicsRow> preset_rows();

/// A length in mm from the table, within ±1 km; errors go to the table.
double length(config::Table& table, const std::string& key, double fallback, double unit_mm);
/// A point in mm.
Vec3 point(config::Table& table, const std::string& key, const Vec3& fallback, double unit_mm);

}  // namespace aircut::machine
