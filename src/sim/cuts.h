// What the tool takes from the stock, stretch by stretch, for whom the forces matter. A stretch is
// short and its cut even. Places and directions are those of the machine's frame M as it stands
// with all joints at zero; mm, s.
#pragma once

#include <cstdint>

#include "sim/sim.h"
#include "stock/stock.h"

namespace aircut::sim {

struct Cut {
  SourceSpan span;
  std::uint64_t block = 0;
  int tool = 0;
  int channel = 0;  ///< whose program it is
  double rpm = 0;   ///< signed, clockwise positive
  double t0 = 0, t1 = 0;
  JointVector joints;              ///< of the machine, in the middle of the stretch
  Vec3 point = Vec3::Zero();       ///< milled: the tip; turned: where the surface is made
  Vec3 point_part = Vec3::Zero();  ///< the same in the stock's frame
  Vec3 feed = Vec3::Zero();        ///< unit, along the tool's way over the work
  double way = 0;                  ///< mm
  double volume = 0;               ///< mm³
  Vec3 axis = Vec3::UnitZ();       ///< milled: from the tip to the spindle
  stock::Engagement in;            ///< milled
  double pitch = 0;                ///< of the stock's lattice
  bool threads = false;            ///< the axis goes with the spindle

  bool turned = false;         ///< an insert in a spinning work; the rest is for this
  double depth = 0;            ///< of what is taken, across the feed; of a plunge its width
  bool plunge = false;         ///< both sides of the tool cut: a groove
  Vec3 normal = Vec3::Zero();  ///< out of the work, across the feed
  double outer = 0, mean = 0;  ///< diameters that are engaged

  double speed() const { return t1 > t0 ? way / (t1 - t0) : 0; }  ///< mm/s
};

class CutListener {
 public:
  virtual ~CutListener() = default;
  /// In order of time.
  virtual void on_cut(const Cut& cut) = 0;
};

/// Stretches of a block's way are at most so long, mm.
inline constexpr double longest_cut = 2;

/// The stock's frame S seen from M at rest, for these joints.
Pose stock_at_rest(const machine::Machine& machine, const machine::RawStock& raw,
                   const JointVector& joints);
/// A cut with what follows from the step alone.
Cut cut_at(const Step& step);

}  // namespace aircut::sim
