// A machine package made from a structural formula: simple bodies, usual limits, ready to be run
// and to be changed by hand.
#pragma once

#include "machine/formula/formula.h"

namespace aircut::machine {

struct PackageFile {
  std::string path;  ///< in the package's folder
  std::string bytes;
};

/// The files of a package with this name; the error says what such a package can't hold.
tl::expected<std::vector<PackageFile>, std::string> package_of(const Formula& formula,
                                                               const std::string& name);

}  // namespace aircut::machine
