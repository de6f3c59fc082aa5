// Private: what a cut asks of the tool, against the limits in the tool file (verification.md §4.3,
// engagement_limit). Depth, width and angle are measured in the stock of that moment; the chip load
// follows from feed, speed and teeth where something is cut; the removal rate from the volume of
// some cells' way, since that of a shorter one is known too roughly.
#pragma once

#include <string>

#include "sim/checks/tool_way.h"
#include "sim/checks/worst_rows.h"
#include "stock/stock.h"

namespace aircut::sim {

class EngagementWatch {
 public:
  /// `tool` may be null; `radius`: of its cutting part, mm.
  void read_tool(const tool::Tool* tool, double radius, double pitch);
  bool on() const { return limits_.any(); }
  /// A straight move of the step that cuts, and how it is in the stock. `name`: the cutter.
  void look(const Step& step, const StraightMove& move, const stock::Engagement& in,
            const std::string& name);
  void finish(Findings& out) { rows_.hand_over("places", out); }

 private:
  void compare(const Step& step, const std::string& name, const char* quantity, double value,
               double limit, const char* unit, const std::string& remedy);

  tool::CuttingLimits limits_;
  int teeth_ = 0;
  double radius_ = 0, pitch_ = 0;
  double way_ = 0, time_ = 0, volume_ = 0;  ///< since the rate was last looked at
  WorstRows rows_{1000};
};

}  // namespace aircut::sim
