// Private: the rows of a kind that may occur in every block of a long program. The worst of them
// are kept and the rest is counted, so that a report stays one that somebody reads and memory does
// not grow with the program.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sim.h"

namespace aircut::sim {

class WorstRows {
 public:
  explicit WorstRows(std::size_t keep) : keep_(keep) {}

  /// Whether a row this bad would be kept; if not, it is counted.
  bool wants(double badness);
  /// Of equally bad rows the earlier ones stay.
  void add(double badness, Finding row);
  /// Gives the rows away; the worst says how many others there were. `what`: "places", "blocks".
  void hand_over(const std::string& what, Findings& out);

 private:
  struct Row {
    double badness = 0;
    Finding finding;
  };
  std::size_t keep_;
  std::uint64_t left_out_ = 0;
  std::vector<Row> rows_;  ///< a heap, the least bad one in front
};

}  // namespace aircut::sim
