// Private: how deep an insert is in a spinning work along its way. Before a move is cut, every ray
// across it tells what the tool would take there:
//
//      r ^        ............ stock           t: length on the ray, seen across the feed
//        |  feed  |  t     |                   n: out of the work, away from the new surface
//        |  <---- |________v new surface
//        +------------------------> z
//
// The side of the tool on which the taken strip ends at the tool's own edge is where the new
// surface is made. When both sides do, the tool goes in with its whole width: a plunge.
//
// A round nose is into a ray before the point that makes the surface comes by, over several moves
// when they are short. So what a ray loses is put together until that point has passed it. Rays of
// much the same depth next to one another make one stretch.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "sim/cuts.h"

namespace aircut::sim {

class TurningCuts {
 public:
  void clear() { samples_.clear(); }
  /// A move that is about to be cut; `s0`, `s1`: where on the step's path.
  void look(const stock::TurnedStock& stock, const stock::TurningMove& move, double s0, double s1);
  /// The stretches of the step's moves. `across`: the direction of r in the stock's frame.
  void hand_over(const Step& step, const machine::RawStock& raw, const Vec3& across, double pitch,
                 CutListener& out);

 private:
  /// One ray.
  struct Sample {
    double s = 0;       ///< on the step's path
    double length = 0;  ///< of the way that it stands for
    double depth = 0, volume = 0;
    double r = 0, z = 0;  ///< of the new surface
    double fr = 0, fz = 0, nr = 0, nz = 0;
    double low = 0, high = 0;  ///< radii
    bool plunge = false;
  };
  /// What a ray has lost so far.
  struct Ray {
    double length = 0, volume = 0;
    double low = 0, high = 0;  ///< radii
  };
  bool together(const Sample& first, const Sample& last, const Sample& next) const;

  void begin(const stock::TurningMove& move, double fr, double fz);

  std::vector<Sample> samples_;                // of the step
  std::array<std::map<double, Ray>, 2> rays_;  // not passed yet: along Z, along r; by their place
  double r_ = 0, z_ = 0, fr_ = 0, fz_ = 0;     // end and direction of the last move
};

}  // namespace aircut::sim
