#include "linuxcnc/folder.h"

#include <algorithm>

namespace aircut::linuxcnc {

namespace fs = std::filesystem;

Folder::Folder(const std::string& file) : shown_(fs::path(file).parent_path()) {
  std::error_code error;
  root_ = fs::canonical(shown_.empty() ? fs::path(".") : shown_, error);
}

Expected<std::string> Folder::resolve(const std::string& name, bool folder) const {
  const auto refuse = [&](const std::string& why) {
    return unexpected(make_error("path_refused", "can't use '" + printable(name) + "': " + why));
  };
  if (name.find_first_of("$`\"'*?\\|;&<>()~") != std::string::npos)
    return refuse("paths are taken as they are written; nothing is expanded here");
  if (name.front() == '/') return refuse("it is absolute; paths start at the set-up's folder");
  for (const fs::path& part : fs::path(name))
    if (part == "..") return refuse("'..' leads out of the set-up's folder");
  std::error_code error;
  const fs::path full = fs::canonical(root_ / name, error);
  if (error)
    return unexpected(
        make_error("input", "there is no '" + printable(name) + "' in the set-up's folder"));
  const auto ends = std::mismatch(root_.begin(), root_.end(), full.begin(), full.end());
  if (ends.first != root_.end()) return refuse("a link leads out of the set-up's folder");
  if (folder ? !fs::is_directory(full, error) : !fs::is_regular_file(full, error))
    return unexpected(make_error(
        "input", "'" + printable(name) + "' is not a " + (folder ? "folder" : "regular file")));
  return (shown_ / name).lexically_normal().string();
}

SourceReader Folder::reader(SourceMap& sources) const {
  return [folder = *this, &sources](const std::string& name) -> Expected<const SourceText*> {
    const auto full = folder.resolve(name, false);
    if (!full) return unexpected(full.error());
    return sources.open(*full);
  };
}

bool Folder::lacks(const std::string& name) const {
  const auto path = resolve(name, false);
  std::error_code error;
  return !path && path.error().kind == "input" && !fs::exists(root_ / name, error);
}

}  // namespace aircut::linuxcnc
