// Private: which cuts are deeper than the vibrations of tool and machine allow.
#pragma once

#include <array>
#include <map>

#include "process/elastic.h"

namespace aircut::process {

class Chatter {
 public:
  /// It outlives this.
  explicit Chatter(const Setup& setup) : setup_(setup), worst_(setup.tools.size()) {}
  void look(const Engaged& engaged);
  /// A warning for each tool, where it is worst.
  void finish(Diagnostics& out) const;

 private:
  struct WorstCut {
    double depth = 0, limit = 0;  ///< mm
    double rpm = 0, t = 0;
    SourceSpan span;
    std::size_t count = 0, milled = 0;
  };
  /// Nothing: no depth chatters.
  std::optional<double> limit(const Engaged& engaged, const accuracy::Mode& mode);

  const Setup& setup_;
  std::vector<WorstCut> worst_;  // as in Setup::tools
  /// By tool, angles, speed and force, each rounded: what the limits depend on.
  std::map<std::array<long, 5>, std::optional<double>> limits_;
};

}  // namespace aircut::process
