#include "geometry/mesh_part.h"

namespace aircut {

TriangleMesh part_of(const TriangleMesh& mesh,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  TriangleMesh out;
  out.triangles.reserve(triangles.size());
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0);  // in `out`, plus 1
  for (std::array<std::uint32_t, 3> t : triangles) {
    for (std::uint32_t& corner : t) {
      if (number[corner] == 0) {
        out.vertices.push_back(mesh.vertices[corner]);
        number[corner] = static_cast<std::uint32_t>(out.vertices.size());
      }
      corner = number[corner] - 1;
    }
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace aircut
