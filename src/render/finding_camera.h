// The camera that shows a contact best.
#pragma once

#include "render/render.h"

namespace aircut::render {

/// How well a picture of body numbers (index + 1, 0 = nothing) shows a contact in its middle.
struct ContactView {
  int width = 0, height = 0;
  std::vector<int> ids;
  bool point_is_open = false;  ///< nothing but bodies in alarm lies between the eye and the contact
  double foreground = 0;       ///< share of pixels with other bodies well in front of the contact
  double cover = 0;  ///< how far in front of the contact the bodies in alarm begin, in spans
};
/// Larger is better. Pixels of every body in alarm count, those near the middle most; a view that
/// shows both bodies beats one that shows twice as much of a single one.
double contact_score(const ContactView& view, const std::vector<DrawBody>& bodies);

/// A camera `span` mm across (the smaller side of the picture) that looks at the point.
Camera contact_camera(const Vec3& point, const Vec3& direction, double span, double aspect);
/// What a step down the list of directions costs, in units of the score.
constexpr double cost_of_rank = 0.012;
/// Directions from the contact to the eye, best liked first.
std::vector<Vec3> candidate_directions();

}  // namespace aircut::render
