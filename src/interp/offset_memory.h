// What a Fanuc-like control keeps of offsets: the work systems and the tool offsets (H, D, and the
// offset number of a lathe's T word). Lengths mm, angles rad; X is always a radius here.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "interp/interp.h"

namespace aircut::interp {

/// One row of the tool offsets. What acts is the sum of geometry and wear.
struct ToolOffset {
  AxisValues geometry, wear;  ///< mills use Z alone: the length
  double radius = 0, radius_wear = 0;
  int orientation = 0;  ///< 0-9, lathe

  AxisValues axes() const { return geometry + wear; }
  double whole_radius() const { return radius + radius_wear; }
};

class OffsetMemory {
 public:
  static constexpr int common = 0;      ///< the offset that is added to every system (EXT)
  static constexpr int extended = 100;  ///< + n: G54.1 Pn, G154 Pn
  static constexpr int max_extended = 300;
  static constexpr int max_tool = 999;

  /// Rows 1… are those of the tool table with the same number.
  explicit OffsetMemory(const tool::ToolTable& tools);
  OffsetMemory() = default;

  /// common, 1-6 (G54-G59), extended + 1 …
  static bool has_system(int system);
  AxisValues& system(int number) { return systems_[slot(number)]; }
  const AxisValues& system(int number) const { return systems_[slot(number)]; }

  /// Machine position of the n-th reference point (G28: 1, G30: 2-4); nothing when it is not known.
  std::optional<AxisValues> reference(int n) const {
    return references_[static_cast<std::size_t>(n - 1)];
  }
  void set_reference(int n, const AxisValues& position) {
    references_[static_cast<std::size_t>(n - 1)] = position;
  }
  /// The first number of a reference point in the parameter file.
  static int reference_number(int n) { return (n <= 2 ? 5141 : 20121) + 20 * n; }

  /// Null when neither the tool table nor the program has given the row.
  const ToolOffset* tool(int number) const;
  /// Makes the row when there is none.
  ToolOffset& tool_to_set(int number) { return tools_[number]; }

 private:
  static std::size_t slot(int system) {
    return static_cast<std::size_t>(system < extended ? system : 6 + system - extended);
  }
  std::vector<AxisValues> systems_ = std::vector<AxisValues>(7 + max_extended);
  std::map<int, ToolOffset> tools_;
  std::array<std::optional<AxisValues>, 4> references_{AxisValues{}};
};

}  // namespace aircut::interp
