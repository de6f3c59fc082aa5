// Private: what is set at the panel at a time.
#pragma once

#include "plan/plan.h"

namespace aircut::plan {

class Overrides {
 public:
  explicit Overrides(std::vector<OverrideEvent> events) : events_(std::move(events)) {}

  bool none() const { return events_.empty(); }
  /// When the next event is; infinity after the last.
  double next() const;
  /// Takes all events up to and with time t.
  void apply(double t);

  /// Factor of the speed that a motion may have; 0 when it is held.
  double factor(const Segment& segment) const;
  double spindle(const Segment& segment) const;

 private:
  std::vector<OverrideEvent> events_;
  std::size_t next_ = 0;
  double feed_ = 1, rapid_ = 1, spindle_ = 1, adaptive_ = 1;
  bool held_ = false;
};

}  // namespace aircut::plan
