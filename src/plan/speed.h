// Private: the fastest speed profile over a chain of pieces, second order.
#pragma once

#include <span>

#include "plan/grid.h"

namespace aircut::plan {

/// Squared speeds that can be braked from, per node of one piece.
using Controllable = std::vector<double>;

/// Fills `out` for a piece that must be left with b ≤ `b_end`.
void brake(const Grid& grid, double b_end, Controllable& out);

/// How long each cause held the speed.
class CauseTimes {
 public:
  void add(Cause cause, double seconds);
  /// The cause with the most time.
  Cause longest() const;

 private:
  static constexpr std::size_t most = 5 * (machine::max_joints + 1);
  std::array<Cause, most> cause_;  ///< none twice
  std::array<double, most> seconds_;
  std::size_t count_ = 0;
};

/// Result of carrying a piece out.
struct Ride {
  SpeedProfile profile;
  double b_end = 0;
  Cause limited_by;  ///< longest
};

/// The ride from b_start that slows down as fast as the limits allow, up to where `controllable` is
/// not passed any more, or to the end. `ride.b_end` is the squared speed there.
struct Descent {
  Ride ride;
  double s = 0;       ///< its way
  bool done = false;  ///< slow enough there
};
Descent descend(const Grid& grid, const Controllable& controllable, double b_start);

/// The fastest ride from b_start, given what brake() found.
Ride accelerate(const Grid& grid, const Controllable& controllable, double b_start);

}  // namespace aircut::plan
