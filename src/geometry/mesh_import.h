// Mesh formats read by assimp, private to the geometry library. assimp's headers stay in the .cpp.
#pragma once

#include <string>
#include <string_view>

#include "geometry/mesh_file.h"

namespace aircut::geometry {

/// A file's bytes and the only folder that it may refer to; an empty folder allows no reference.
struct ImportSource {
  std::string_view bytes;
  std::string name;       ///< file name without folder
  std::string extension;  ///< lower case, without point
  std::string folder;
};

/// Triangles in mm (formats with a unit) or in the file's unit; node transforms applied, not
/// welded. Errors are sentences that go after the file's name.
tl::expected<TriangleMesh, std::string> import_mesh(const ImportSource& source,
                                                    const MeshFileOptions& options);

}  // namespace aircut::geometry
