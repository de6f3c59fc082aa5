// A triangle mesh made ready for drawing: normals that are smooth on rounds and split at creases,
// and the edges that a draughtsman would draw.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::render {

struct DrawVertex {
  std::array<float, 3> position;
  std::array<float, 3> normal;
};

/// An edge between two triangles. Where there is one triangle only, both normals are its own.
struct DrawEdge {
  std::array<float, 3> a, b;
  std::array<float, 3> normal_1, normal_2;  ///< of the triangles at both sides, unit
  bool crease = false;  ///< always drawn; others only where they are the outline
};

struct DrawMesh {
  std::vector<DrawVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<DrawEdge> edges;  ///< creases first; edges between coplanar triangles are left out
  bool closed = false;          ///< no rim, all triangles turned outwards: back faces can be culled
  Box3 box;
  double area = 0;  ///< mm²
};

/// Triangles without area and corners that are not finite are left out.
DrawMesh make_draw_mesh(const TriangleMesh& mesh);

}  // namespace aircut::render
