// Triangles of a plane polygon, private to the geometry library.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/mesh.h"

namespace aircut::geometry {

/// Appends the triangles of a polygon whose corners are vertices of the mesh, counter-clockwise
/// seen from outside. Fewer than three corners give nothing.
void append_polygon(TriangleMesh& mesh, std::span<const std::uint32_t> corners);

}  // namespace aircut::geometry
