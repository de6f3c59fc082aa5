// How the readers get at the files of a package. Paths are relative to the package's folder; a path
// that leaves it is refused. Tests and the fuzz target hand in functions that need no disk.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/base.h"
#include "geometry/geometry.h"

namespace aircut::machine {

struct PackageFiles {
  std::function<Expected<std::shared_ptr<const TriangleMesh>>(const std::string& path,
                                                              const MeshFileOptions&)>
      mesh;
  std::function<Expected<const SourceText*>(const std::string& path)> text;
  /// The full path of an existing file, for readers of other libraries.
  std::function<Expected<std::string>(const std::string& path)> full_path;
};

/// Files of a folder; a mesh that is asked for again (same units) is shared.
PackageFiles disk_files(const std::string& folder, SourceMap& sources);

}  // namespace aircut::machine
