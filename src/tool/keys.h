// Reading keys of tools.toml with their ranges. Private to tool.
#pragma once

#include <numbers>
#include <optional>
#include <string>

#include "config/config.h"
#include "geometry/geometry.h"

namespace aircut::tool {

inline constexpr const char* kind_of_errors = "tools_invalid";
inline constexpr double radians_per_degree = std::numbers::pi / 180;
inline constexpr double same_length = 1e-6;        // mm
inline constexpr double largest_length = 100'000;  // mm; keeps sums and squares far from overflow

/// Lengths and angles of one table. A value that is missing or wrong is an error at its key.
class Lengths {
 public:
  Lengths(config::Table& table, double unit_mm) : table_(table), unit_mm_(unit_mm) {}

  /// In mm.
  std::optional<double> optional(const std::string& key, bool zero_allowed);
  /// In mm; 1 after an error.
  double required(const std::string& key);
  /// An angle in rad, from more than `low` to less than `high` degrees.
  std::optional<double> angle(const std::string& key, double low, double high);
  /// 1 after an error.
  double required_angle(const std::string& key, double low, double high);
  void fail(const std::string& key, const std::string& message);
  bool good() const { return good_; }
  config::Table& table() { return table_; }
  double unit_mm() const { return unit_mm_; }

 private:
  config::Table& table_;
  double unit_mm_;
  bool good_ = true;
};

/// `profile = [[r, z], …]`: radii of 0 or more, heights that start at 0 and never go down, and a
/// body that is not empty.
std::optional<Profile> read_profile(config::Table& table, const std::string& key, double unit_mm);

/// A cutter's outline and its greatest diameter, mm.
struct Cutter {
  Profile outline;
  double diameter = 0;
};

/// The words that `kind` may be; "turning" is one that has no outline.
const std::vector<std::string>& cutter_kinds();
/// Reads the keys of a cutter of this kind, which is not "turning".
std::optional<Cutter> read_cutter(Lengths& in, const std::string& kind);

}  // namespace aircut::tool
