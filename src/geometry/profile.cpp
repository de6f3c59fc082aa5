// Solids of revolution as closed meshes.
//
// Every circle of the outline becomes a regular n-gon around it (its sides touch the circle), so
// the mesh contains the solid: corners lie at r / cos(π/n), which is at most `tolerance` too far
// out for
//
//   R (1/cos(π/n) − 1) ≤ tolerance,   R the largest radius.
//
// Polygons of neighbouring heights are similar and equally turned, so the faces between them are
// plane trapezoids and the section at any height between is again an n-gon around the circle.
#include "geometry/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aircut {
namespace {

constexpr unsigned min_facets = 12;
/// Below a millionth of the radius the facets would only cost memory; that is n = 2224.
constexpr double min_relative_tolerance = 1e-6;

unsigned facet_count(double radius, double tolerance) {
  const double excess = std::max(tolerance / radius, min_relative_tolerance);
  const double half_angle = std::acos(1 / (1 + excess));
  const double n = std::ceil(std::numbers::pi / half_angle);
  unsigned facets = std::max(min_facets, (static_cast<unsigned>(n) + 3) / 4 * 4);
  while (1 / std::cos(std::numbers::pi / facets) - 1 > excess) facets += 4;
  return facets;
}

/// Unit vectors of the corners; the four quadrants are exact copies of each other.
std::vector<Eigen::Vector2d> corner_directions(unsigned facets) {
  std::vector<Eigen::Vector2d> out(facets);
  const unsigned quarter = facets / 4;
  for (unsigned i = 0; i < quarter; ++i) {
    const double angle = 2 * std::numbers::pi * i / facets;
    const double c = std::cos(angle), s = i == 0 ? 0.0 : std::sin(angle);
    out[i] = {c, s};
    out[i + quarter] = {-s, c};
    out[i + 2 * quarter] = {-c, -s};
    out[i + 3 * quarter] = {s, -c};
  }
  return out;
}

/// The outline from axis to axis, without points that repeat.
Profile closed_to_axis(const Profile& profile) {
  Profile out;
  const auto add = [&](ProfilePoint p) {
    if (out.empty() || out.back().r != p.r || out.back().z != p.z) out.push_back(p);
  };
  if (profile.empty()) return out;
  add({0, profile.front().z});
  for (const ProfilePoint& p : profile) add({std::max(p.r, 0.0), p.z});
  add({0, profile.back().z});
  return out;
}

}  // namespace

TriangleMesh revolve(const Profile& profile, double tolerance) {
  const Profile outline = closed_to_axis(profile);
  double radius = 0;
  for (const ProfilePoint& p : outline) radius = std::max(radius, p.r);
  TriangleMesh mesh;
  if (!(radius > 0)) return mesh;

  const unsigned n = facet_count(radius, tolerance);
  const std::vector<Eigen::Vector2d> corners = corner_directions(n);
  // The last factor keeps rounding from bringing a side inside of its circle.
  const double outward = 1 / std::cos(std::numbers::pi / n) * (1 + 4e-16);

  // A ring has n vertices, a point on the axis one.
  std::vector<std::uint32_t> first;
  for (const ProfilePoint& p : outline) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    if (p.r == 0) {
      mesh.vertices.emplace_back(0, 0, p.z);
      continue;
    }
    for (const Eigen::Vector2d& c : corners)
      mesh.vertices.emplace_back(p.r * outward * c.x(), p.r * outward * c.y(), p.z);
  }
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const bool lower_ring = outline[i].r > 0, upper_ring = outline[i + 1].r > 0;
    for (unsigned j = 0; j < n; ++j) {
      const unsigned next = (j + 1) % n;
      const auto low = [&](unsigned k) { return first[i] + (lower_ring ? k : 0); };
      const auto high = [&](unsigned k) { return first[i + 1] + (upper_ring ? k : 0); };
      if (lower_ring) mesh.triangles.push_back({low(j), low(next), high(next)});
      if (upper_ring) mesh.triangles.push_back({low(j), high(next), high(j)});
    }
  }
  return mesh;
}

}  // namespace aircut
