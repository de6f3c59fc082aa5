// Private: the findings of tools in the stock, as milling (cutting.h) and turning (turning.h) tell
// them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/checks/tool_way.h"
#include "sim/sim.h"

namespace aircut::sim {

/// More than a touch: deeper than ε_cut or more than V_cut (verification.md §4.3); mm, mm³.
inline constexpr double touch_depth = 0.01, touch_volume = 0.01;
inline bool takes_material(double depth, double volume) {
  return depth > touch_depth || volume > touch_volume;
}

/// Whether the step is a rapid or a tool change. Where a rapid and a feed move are rounded into one
/// another, neither is at its full speed.
bool is_rapid(const Step& step);

/// The row that says from where on nobody knows what is left of the stock.
Finding lost_stock(const Step& step, const std::string& why);

/// Feed moves at most so long may take nothing, mm.
inline constexpr double longest_air = 20;
void add_air_cut(const Step& step, Findings& out);

/// A solid of the tool in a row.
struct Who {
  std::string name;
  machine::Role role;
};
/// A row about a move, from the first fraction of it for which `enough(fraction)` holds: what a
/// longer part of the move takes, it takes too. `point` is in the frame of the stock.
Finding cut_row(Kind kind, const Step& step, const StraightMove& move, const Who& who,
                const machine::RawStock& raw, const Vec3& point,
                const std::function<bool(double)>& enough);
/// What a row says of a shank or holder that runs into stock; without a bound no depth is told.
void tell_hit(Finding& row, const Who& who, std::optional<double> depth_bound,
              const std::string& remedy);
/// What it says when neither contact nor clearance could be proven.
void tell_doubt(Finding& row, const Who& who, double pitch);

/// The rows of one step.
class CutRows {
 public:
  void clear() { rows_.clear(); }
  /// Adds a row, or lengthens the one of the same kind and body. No depth: it is not measured.
  void tell(Finding row, std::optional<double> depth, double volume);
  /// With the volumes in their messages.
  void hand_over(Findings& out);

 private:
  std::vector<Finding> rows_;
};

}  // namespace aircut::sim
