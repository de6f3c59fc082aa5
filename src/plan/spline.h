// Private: NURBS as pieces of quintic curves.
#pragma once

#include "plan/geometry.h"

namespace aircut::plan {

/// The curve from `start` (whose other axes stay) as pieces that meet with tangent and curvature.
/// Bezier curves and B-splines up to degree 5 are exact; others within 1e-5 mm. Empty when the
/// curve has no length.
std::vector<Blend> spline_pieces(const AxisValues& start, const canon::SplineFeed& spline);

}  // namespace aircut::plan
