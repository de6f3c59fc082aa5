// A mesh with short edges: for what is told by place on a surface.
#pragma once

#include "geometry/mesh.h"

namespace aircut {

/// The same surface with no edge longer than `longest` (mm, above 0), or as short as `most`
/// triangles allow. What was shared stays shared, so a closed mesh stays closed.
TriangleMesh with_short_edges(TriangleMesh mesh, double longest, std::size_t most);

}  // namespace aircut
