// Files that are complete or absent: written under a temporary name in the same folder, then
// renamed.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "base/expected.h"

namespace aircut {

class OutputFile {
 public:
  /// Error kind `output_failed`: the folder is missing or can't be written.
  static Expected<OutputFile> create(const std::string& path);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  /// A file that was not committed is removed.
  ~OutputFile();

  /// Buffered. A failure (disk full) is remembered and returned by commit().
  void write(std::string_view bytes);
  /// Flushes, syncs and renames to the final path.
  Expected<void> commit();
  const std::string& path() const { return path_; }

 private:
  OutputFile() = default;
  void discard();

  std::string path_;
  std::string temporary_;
  std::FILE* file_ = nullptr;
  bool failed_ = false;
};

/// create, write, commit.
Expected<void> write_file(const std::string& path, std::string_view bytes);

}  // namespace aircut
