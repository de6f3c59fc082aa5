// Chooses where a contact is seen from. Some twenty directions around the point, as a person would
// walk around the machine, are each drawn small with body numbers for colours. A view is good when
// the bodies in alarm cover much of the picture's middle, all of them, nothing else hides the point
// and little stands in the foreground. Among equals the operator's side wins: directions come in
// order of liking, and every step down that list costs a little.
#include "render/finding_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut::render {

std::vector<Vec3> candidate_directions() {
  std::vector<Vec3> out;
  // Turns from the front (degrees, to the right), by preference; then the heights above the level.
  for (const double turn_deg : {32.0, -32.0, 0.0, 68.0, -68.0, 112.0, -112.0, 150.0, -150.0})
    for (const double height_deg : {30.0, 12.0, 55.0}) {
      const double a = turn_deg * std::numbers::pi / 180, h = height_deg * std::numbers::pi / 180;
      out.emplace_back(std::cos(h) * std::sin(a), -std::cos(h) * std::cos(a), std::sin(h));
    }
  out.emplace_back(0, 0, 1);
  out.emplace_back(Vec3(0.45, -0.8, -0.4).normalized());  // from below, for what hangs over
  return out;
}

double contact_score(const ContactView& view, const std::vector<DrawBody>& bodies) {
  std::vector<double> seen(bodies.size(), 0);
  double all = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      // Weight falls from 1 in the middle to 0 at the nearer border.
      const double dx = (x + 0.5) / view.height - 0.5 * view.width / view.height;
      const double dy = (y + 0.5) / view.height - 0.5;
      const double weight = std::max(0.0, 1 - 4 * (dx * dx + dy * dy));
      all += weight;
      const int id = view.ids[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                              static_cast<std::size_t>(x)];
      if (id > 0 && static_cast<std::size_t>(id) <= bodies.size())
        seen[static_cast<std::size_t>(id) - 1] += weight;
    }
  double sum = 0, least = 1e300;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].highlight) continue;
    // The root makes a little of each body worth more than a lot of one.
    const double share = std::sqrt(seen[i] / std::max(all, 1e-9));
    sum += share;
    least = std::min(least, share);
  }
  if (sum == 0) return 0;
  // The contact itself is seen when the surface in front of it is near: e-fold in a tenth of the
  // span.
  const double bare = std::exp(-10 * std::max(view.cover, 0.0));
  return sum + 2 * least + (view.point_is_open ? 1.0 : 0.0) + 0.7 * bare - 0.8 * view.foreground;
}

Camera contact_camera(const Vec3& point, const Vec3& direction, double span, double aspect) {
  Camera out;
  out.field_of_view = 0.45;
  out.target = point;
  // `span` must fit into the smaller side.
  const double vertical = std::max(span, 1e-3) / std::min(1.0, std::max(aspect, 1e-3));
  out.eye = point + direction * (vertical / 2 / std::tan(out.field_of_view / 2));
  if (std::abs(direction.z()) > 0.999) out.up = Vec3::UnitY();
  return out;
}

Camera camera_for_finding(const std::vector<DrawBody>& bodies, const Vec3& point, double span,
                          double aspect) {
  constexpr int height = 120;
  const int width = static_cast<int>(std::lround(height * std::clamp(aspect, 0.2, 5.0)));
  auto renderer = Renderer::create({width, height});
  // Without a renderer no picture follows either; the first direction is as good as any.
  if (!renderer) return contact_camera(point, candidate_directions().front(), span, aspect);
  return renderer->camera_for_finding(bodies, point, span);
}

}  // namespace aircut::render
