// A workspace as files for other programs.
#pragma once

#include <string>

#include "geometry/geometry.h"
#include "machine/workspace/workspace.h"

namespace aircut::machine {

/// A row per point: x_mm, y_mm, z_mm, reached (0 or 1); x fastest.
std::string workspace_csv(const Workspace& workspace);
/// NumPy, unsigned bytes of shape (z, y, x): 1 = reached.
std::string workspace_npy(const Workspace& workspace);
/// The skin of the cells that are reached, each a cube of one pitch about its point, mm.
TriangleMesh workspace_solid(const Workspace& workspace);

}  // namespace aircut::machine
