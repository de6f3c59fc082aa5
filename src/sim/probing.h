// Private: what a probing move meets, found before it is planned.
#pragma once

#include "sim/checks/pairs.h"
#include "sim/sim.h"

namespace aircut::sim {

/// What is looked at for one probing move.
struct ProbeScene {
  const Scene& scene;
  const machine::MotionBound& bound;
  JointVector joints;        ///< where the move begins
  const plan::Segment& way;  ///< the whole move at 1 mm (or rad) a second
  bool away = false;         ///< G38.4, G38.5: until nothing is touched any more
  /// The stock as it is now, in the frame of its body; null when there is none.
  std::shared_ptr<const collide::CollisionMesh> stock;
};

ProbeResult find_trip(const ProbeScene& probing);

}  // namespace aircut::sim
