// Files and folders that a set-up names: below its own folder, links resolved.
#pragma once

#include <filesystem>
#include <string>

#include "base/base.h"

namespace aircut::linuxcnc {

class Folder {
 public:
  /// That of the set-up file `file`.
  explicit Folder(const std::string& file);

  /// The path as messages show it, or why it can't be used (`path_refused`, `input`).
  Expected<std::string> resolve(const std::string& name, bool folder) const;
  /// Opens the texts that a set-up names.
  SourceReader reader(SourceMap& sources) const;
  /// Nothing has that name, and it is one that could be used.
  bool lacks(const std::string& name) const;

 private:
  std::filesystem::path shown_, root_;
};

}  // namespace aircut::linuxcnc
