// Private: which cuts are under way at the same time. The time is cut wherever one begins or ends;
// inside of a piece all of them load the machine together. A channel has one tool: its own cuts,
// which may overlap by a ray of the stock, never load the machine twice.
#pragma once

#include <functional>
#include <vector>

#include "sim/cuts.h"

namespace aircut::process {

class Together {
 public:
  /// The cuts of one piece of time, each shortened to it: its times, way and volume.
  using Take = std::function<void(std::vector<sim::Cut>&)>;
  explicit Together(Take take) : take_(std::move(take)) {}

  /// In order of their begin; false: it begins in a piece that was already handed over, and is left
  /// out.
  bool add(const sim::Cut& cut);
  /// No cut comes any more.
  void finish();

 private:
  void hand_over(double until);

  Take take_;
  std::vector<sim::Cut> open_;  // none of them is over before `now_`
  std::vector<sim::Cut> piece_;
  double now_ = 0;
};

}  // namespace aircut::process
