// PLY text and binary, private to the geometry library.
#pragma once

#include <string>
#include <string_view>

#include "geometry/mesh_file.h"

namespace aircut::geometry {

/// Polygons are cut into triangles; in the file's unit, not welded. Errors are sentences that go
/// after the file's name.
tl::expected<TriangleMesh, std::string> read_ply(std::string_view bytes, std::size_t max_triangles);

}  // namespace aircut::geometry
