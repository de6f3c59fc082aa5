// A block with a slot along X through its middle, as a closed mesh: the part of several tests.
#pragma once

#include "geometry/geometry.h"

namespace aircut::testing {

/// The block is `size`, its middle at x = y = 0, its lower face at z = 0.
inline TriangleMesh slotted_block(const Vec3& size, double width, double depth) {
  //  7___6  3___2 ... seen along X: 0 and 1 are the lower corners, 4 and 5 the slot's floor
  const double y = size.y() / 2, w = width / 2, z = size.z(), floor = z - depth;
  const double outline[8][2] = {{-y, 0},    {y, 0},      {y, z},  {w, z},
                                {w, floor}, {-w, floor}, {-w, z}, {-y, z}};
  TriangleMesh mesh;
  for (const double x : {-size.x() / 2, size.x() / 2})
    for (const auto& p : outline) mesh.vertices.emplace_back(x, p[0], p[1]);
  // The end face as three quadrangles that share their corners.
  const std::uint32_t quads[3][4] = {{0, 1, 4, 5}, {1, 2, 3, 4}, {0, 5, 6, 7}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0] + 8, q[1] + 8, q[2] + 8});
    mesh.triangles.push_back({q[0] + 8, q[2] + 8, q[3] + 8});
    mesh.triangles.push_back({q[0], q[2], q[1]});
    mesh.triangles.push_back({q[0], q[3], q[2]});
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t j = (i + 1) % 8;
    mesh.triangles.push_back({i, j, j + 8});
    mesh.triangles.push_back({i, j + 8, i + 8});
  }
  return mesh;
}

}  // namespace aircut::testing
