// Private: what is kept of all cuts: the worst places of each tool, named sizes, limits.
#pragma once

#include "process/elastic.h"

namespace aircut::process {

class Tally {
 public:
  /// Both outlive it.
  Tally(const Setup& setup, Remarks& remarks);
  /// `sides`: of the bodies, for its tool.
  void add(const Engaged& engaged, const Answer& found, const std::vector<int>& sides);
  /// Findings and warnings go to `out`.
  Summary finish(Diagnostics& out);

 private:
  /// The errors of one tool in a size.
  struct SizeTool {
    double least = 0, most = 0, sum = 0, time = 0;
    double low = 0, high = 0;
    accuracy::Field widest;
    SourceSpan span;  ///< of the largest error
    double largest = -1;
  };
  void add_sizes(const Engaged& engaged, const Answer& found);
  void tell_limits(const ToolSummary& tool, Diagnostics& out) const;
  accuracy::DimensionResult dimension(std::size_t index, Diagnostics& out);
  std::string name(std::size_t tool) const { return "T" + std::to_string(setup_.tools[tool].id); }

  const Setup& setup_;
  Remarks& remarks_;
  std::vector<ToolSummary> tools_;  // as in Setup::tools
  std::vector<std::vector<SizeTool>> sizes_;
  double way_ = 0, t_end_ = -1;
};

}  // namespace aircut::process
