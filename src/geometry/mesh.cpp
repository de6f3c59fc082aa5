#include "geometry/mesh.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "geometry/profile.h"

namespace aircut {

Box3 bounds(const TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles)
    six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return six / 6;
}

double radius_about(const TriangleMesh& mesh, const Vec3& point) {
  double r2 = 0;
  for (const Vec3& v : mesh.vertices) r2 = std::max(r2, (v - point).squaredNorm());
  return std::sqrt(r2);
}

TriangleMesh make_box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1u) ? high.x() : low.x(), (i & 2u) ? high.y() : low.y(),
                               (i & 4u) ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& v : part.vertices) mesh.vertices.push_back(X * v);
  for (const auto& t : part.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TriangleMesh transformed(const TriangleMesh& mesh, const Pose& X) {
  TriangleMesh out;
  append(out, mesh, X);
  return out;
}

}  // namespace aircut
