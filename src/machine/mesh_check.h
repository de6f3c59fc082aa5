#pragma once

#include <memory>
#include <string>

#include "geometry/geometry.h"
#include "machine/package_files.h"

namespace aircut::machine {

/// Does the surface have no border? Edges that meet along a line without meeting at the same
/// vertices (T-junctions, which welding leaves where it drops triangles without area) count as
/// joined.
bool without_border(const TriangleMesh& mesh);

/// The mesh of a solid that a set-up names: closed, facing outwards. `what`: "stock", "part".
/// Errors of kind `setup_invalid` at `span`, since the file is the set-up's, not the machine's.
Expected<std::shared_ptr<const TriangleMesh>> setup_solid(const PackageFiles& files,
                                                          const std::string& path,
                                                          const MeshFileOptions& options,
                                                          const SourceSpan& span,
                                                          const std::string& what);

}  // namespace aircut::machine
