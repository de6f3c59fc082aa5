// How far a move goes, as its feed counts it.
#pragma once

#include "canon/canon.h"

namespace aircut::canon {

/// X Y Z; when they rest, U V W; when those rest too, A B C.
struct Way {
  double length = 0;    ///< mm; of rotary axes rad
  bool rotary = false;  ///< of A B C
};

Way straight_way(const AxisValues& from, const AxisValues& to);
/// Along the arc or helix, with its extra turns; a line when it has no turns.
Way arc_way(const AxisValues& from, const ArcFeed& arc);

}  // namespace aircut::canon
