#pragma once

#include <span>

#include "geometry/mesh.h"

namespace aircut {

/// Some triangles of a mesh, with the vertices that they use.
TriangleMesh part_of(const TriangleMesh& mesh,
                     std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace aircut
