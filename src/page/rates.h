// How near the joints come to their limits over a run, and how fast material goes.
#pragma once

#include <vector>

#include "base/time_buckets.h"
#include "sim/sim.h"

namespace aircut::page {

/// The joints' largest speeds, accelerations and jerks in equal stretches of time.
class Rates {
 public:
  enum Measure { speed, acceleration, jerk, measures };
  struct Peaks {
    std::vector<float> of;  ///< [joint * measures + measure], mm or rad and s
    void merge(const Peaks& other);
  };

  /// A stretch of the step's time law between two knots or a part of it, in program time.
  void look(const sim::Step& step, double t0, double t1);
  const TimeBuckets<Peaks>& peaks() const { return peaks_; }

 private:
  TimeBuckets<Peaks> peaks_;
  Peaks here_;  ///< of the stretch at hand
};

}  // namespace aircut::page
