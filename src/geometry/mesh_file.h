#pragma once

#include <cstddef>
#include <string>

#include "base/base.h"
#include "geometry/mesh.h"

namespace aircut {

struct MeshFileOptions {
  double unit_mm = 1.0;  ///< length of one unit of the file; glTF's metre is already applied
  bool y_up = false;     ///< the file's Y axis points up: turned to Z up
  std::size_t max_triangles = 5'000'000;
  std::size_t max_bytes = 1'000'000'000;
};

/// Reads STL, OBJ, PLY, COLLADA, glTF/GLB or 3MF; node transforms applied, welded, mm.
/// Error kind `mesh_invalid`: missing, unreadable, unknown format, no triangles, NaN, too large.
Expected<TriangleMesh> read_mesh(const std::string& path, const MeshFileOptions& options = {});

/// Binary STL, mm.
std::string stl_bytes(const TriangleMesh& mesh);

}  // namespace aircut
