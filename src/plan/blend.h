// Private: rounding of corners (G64 P).
#pragma once

#include <functional>

#include "plan/geometry.h"

namespace aircut::plan {

/// A corner between the end of `left` and the start of `right`; both count F along XYZ.
struct CornerShape {
  const Path& left;
  const Path& right;
  double left_room = 0;  ///< how much of each may be cut off, along s
  double right_room = 0;
  double tolerance = 0;  ///< G64 P, mm; 0 = no limit
};

/// How a blend between two lines, each cut by 1 mm, is built of the lines' directions by their XYZ
/// length: p' = d[0] · in + d[1] · out, p'' = dd[0] · in + dd[1] · out at even places from its
/// start to its end. A cut of c mm makes p'' smaller by c and leaves p' as it is.
struct CornerRates {
  struct Place {
    std::array<double, 2> d, dd;
  };
  std::array<Place, 17> at;
  double length = 0;
};

/// q' and q'' of the joints along the two sides of a corner between lines, by the lines' length.
struct CornerDirections {
  machine::JointVector in, out, bend_in, bend_out;
};

struct CornerBlend {
  Blend blend;
  double cut = 0;  ///< taken off each side, along s
  /// Between lines; nothing where the table does not have this curve's parameter.
  std::optional<CornerRates> rates = {};
  CornerDirections directions = {};  ///< empty where they are not known
};

/// How large the acceleration on a blend would be at the wanted speed, as a share of the limits.
struct Demand {
  std::function<double(const Blend&)> of_blend;
  /// For a blend between lines that cuts off `cut` mm, where the joints go so nearly straight with
  /// the tip that their directions along the lines tell it; empty elsewhere.
  std::function<double(const CornerRates&, double cut)> of_lines;
};

/// The blend, no rounder than `demand` asks for; nothing where the corner must be a stop.
std::optional<CornerBlend> make_blend(const CornerShape& corner, const Demand& demand);

}  // namespace aircut::plan
