#pragma once

#include "geometry/geometry.h"

namespace aircut::machine {

/// Does the surface have no border? Edges that meet along a line without meeting at the same
/// vertices (T-junctions, which welding leaves where it drops triangles without area) count as
/// joined.
bool without_border(const TriangleMesh& mesh);

}  // namespace aircut::machine
