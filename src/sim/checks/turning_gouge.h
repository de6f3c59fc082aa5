// Private: where a turning move goes into the part that a job makes.
#pragma once

#include <functional>
#include <optional>

#include "stock/stock.h"

namespace aircut::sim {

struct TurningGouge {
  double depth = 0;     ///< mm under the part's surface
  double r = 0, z = 0;  ///< where; r is 0 or more
};

/// What is known of the bar without asking the part.
struct RawBar {
  double radius = 0, height = 0;  ///< the part lies inside of it; z from 0
};

/// The deepest place of what the move sweeps that lies more than `tolerance` inside of the part and
/// is still material, as `is_material(r, z)` tells. What is deeper than tolerance + bound at the
/// outline of the sweep is found.
std::optional<TurningGouge> deepest_in_part(const stock::TurningMove& move, const stock::Part& part,
                                            const RawBar& bar, double tolerance, double bound,
                                            const std::function<bool(double, double)>& is_material);

}  // namespace aircut::sim
