// A corner between two pieces of a path, rounded or cut off: A and C of LinuxCNC's contours, `,R`
// and `,C` of Fanuc's moves.
#pragma once

#include <optional>

#include "interp/contour.h"

namespace aircut::interp {

struct CornerWord {
  enum class Kind : unsigned char {
    none,
    round,          ///< an arc of radius `size`, tangent to both pieces
    chamfer,        ///< a line between the points at the distance `size` from the corner
    chamfer_round,  ///< a line between the ends of the arc of radius `size`
  } kind = Kind::none;
  double size = 0;  ///< mm
};

/// The piece that replaces the corner: `before` ends where it starts and `after` starts where it
/// ends. Nothing when it does not fit on the two pieces.
std::optional<ContourPiece> cut_corner(const ContourPiece& before, const ContourPiece& after,
                                       CornerWord word);

}  // namespace aircut::interp
