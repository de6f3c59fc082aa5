#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/base.h"
#include "geometry/mesh.h"

namespace aircut {

struct MeshFileOptions {
  /// Length of one unit of an STL, OBJ or PLY file, which do not say it. glTF (metres), COLLADA and
  /// 3MF state their unit themselves and are brought to mm by it.
  double unit_mm = 1.0;
  bool y_up = false;  ///< the file's Y axis points up: turned to Z up. Never guessed from the file
  std::size_t max_triangles = 5'000'000;
  std::size_t max_bytes = 1'000'000'000;  ///< of the file and all it refers to, unpacked
};

/// Reads STL, OBJ, PLY, COLLADA, glTF/GLB or 3MF; node transforms applied, welded, mm.
/// Error kind `mesh_invalid`: missing, unreadable, unknown format, no triangles, NaN, too large.
Expected<TriangleMesh> read_mesh(const std::string& path, const MeshFileOptions& options = {});

/// The same from memory. `name` is what messages call it; its extension says the format. Files that
/// the text refers to are not opened.
Expected<TriangleMesh> read_mesh_bytes(std::string_view bytes, const std::string& name,
                                       const MeshFileOptions& options = {});

/// Binary STL, mm.
std::string stl_bytes(const TriangleMesh& mesh);

}  // namespace aircut
