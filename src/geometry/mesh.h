#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/pose.h"

namespace aircut {

/// Triangles over shared vertices, mm; corners run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  bool empty() const { return triangles.empty(); }
};

Box3 bounds(const TriangleMesh& mesh);
/// Volume by the divergence theorem, mm³; means something only for a closed mesh.
double volume(const TriangleMesh& mesh);
/// Largest distance of a vertex from `point`, mm.
double radius_about(const TriangleMesh& mesh, const Vec3& point);

/// Welds vertices whose positions are exactly equal and drops triangles without area.
TriangleMesh welded(const TriangleMesh& mesh);

/// A connected set of triangles.
struct Shell {
  std::vector<std::uint32_t> triangles;  ///< indices into the mesh
  bool closed = false;  ///< every edge has exactly two triangles, running opposite ways
};
/// Shells in order of their first triangle; the mesh must be welded.
std::vector<Shell> shells(const TriangleMesh& mesh);

/// Solids for tests, stock and simple bodies, mm.
TriangleMesh make_box(const Vec3& low, const Vec3& high);
/// Appends `part`, placed by X.
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X = Pose::Identity());
TriangleMesh transformed(const TriangleMesh& mesh, const Pose& X);

}  // namespace aircut
