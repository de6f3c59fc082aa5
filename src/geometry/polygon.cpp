// Ear clipping: a corner is an ear when it is convex and no other corner lies in its triangle.
// Cutting off an ear leaves a polygon with one corner less. The plane's normal is the sum of the
// cross products of neighbouring corners (Newell), so corners need not be exactly in a plane.
#include "geometry/polygon.h"

#include <vector>

namespace aircut::geometry {
namespace {

/// Ear clipping takes n³ steps at worst; longer polygons are cut as a fan.
constexpr std::size_t max_clipped = 512;

Vec3 normal_of(const TriangleMesh& mesh, std::span<const std::uint32_t> corners) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = mesh.vertices[corners.front()];
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += (mesh.vertices[corners[i]] - origin)
               .cross(mesh.vertices[corners[(i + 1) % corners.size()]] - origin);
  return sum;
}

/// Twice the signed area seen against `normal`.
double turn(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c) {
  return normal.dot((b - a).cross(c - a));
}

bool is_ear(const TriangleMesh& mesh, const std::vector<std::uint32_t>& ring, std::size_t i,
            const Vec3& normal) {
  const std::size_t n = ring.size();
  const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
  const Vec3 &a = mesh.vertices[ring[before]], &b = mesh.vertices[ring[i]],
             &c = mesh.vertices[ring[after]];
  if (turn(normal, a, b, c) <= 0) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == before || k == i || k == after) continue;
    const Vec3& p = mesh.vertices[ring[k]];
    if (p == a || p == b || p == c) continue;
    if (turn(normal, a, b, p) >= 0 && turn(normal, b, c, p) >= 0 && turn(normal, c, a, p) >= 0)
      return false;
  }
  return true;
}

}  // namespace

void append_polygon(TriangleMesh& mesh, std::span<const std::uint32_t> corners) {
  std::vector<std::uint32_t> ring(corners.begin(), corners.end());
  if (ring.size() < 3) return;
  const Vec3 normal = normal_of(mesh, corners);
  std::size_t i = 0, tried = 0;
  while (ring.size() > 3 && ring.size() <= max_clipped && tried < ring.size()) {
    if (!is_ear(mesh, ring, i, normal)) {
      i = (i + 1) % ring.size();
      ++tried;
      continue;
    }
    const std::size_t n = ring.size();
    mesh.triangles.push_back({ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    i %= ring.size();
    tried = 0;
  }
  // What is left is a triangle, or has no ear (it crosses itself): a fan keeps its outline.
  for (std::size_t k = 1; k + 1 < ring.size(); ++k)
    mesh.triangles.push_back({ring[0], ring[k], ring[k + 1]});
}

}  // namespace aircut::geometry
