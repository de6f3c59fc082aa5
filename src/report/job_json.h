// The result of a job of several operations.
#pragma once

#include <string>
#include <vector>

#include "sim/sim.h"

namespace aircut::report {

struct JobOperation {
  std::string name, program;
  std::string folder;  ///< in the job's; empty: nothing was written
  bool run = false;
  std::string reason;  ///< why it was not run
  sim::Verdict verdict = sim::Verdict::unknown;
  double cycle_time = 0;  ///< s
};

/// fail if any fails, else unknown if any is not known, else pass.
sim::Verdict verdict_of(const std::vector<JobOperation>& operations);
std::string to_json(const std::vector<JobOperation>& operations);

}  // namespace aircut::report
