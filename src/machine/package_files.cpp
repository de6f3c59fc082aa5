#include "machine/package_files.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

namespace aircut::machine {

namespace {

namespace fs = std::filesystem;

// What is wrong with a path as it is written, or nothing.
std::optional<std::string> problem_of(const std::string& path) {
  if (path.empty()) return "the path is empty";
  for (const char c : path)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return "the path holds a control character";
  if (path.front() == '/') return "it is absolute; paths are relative to the package's folder";
  if (path.find('\\') != std::string::npos) return "folders are separated by '/', not by '\\'";
  for (const fs::path& part : fs::path(path))
    if (part == "..") return "'..' leads out of the package's folder";
  return std::nullopt;
}

// The file that was most likely meant, as a sentence.
std::string suggestion(const fs::path& full) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator it(full.parent_path(), error);
  while (!error && it != fs::directory_iterator()) {
    names.push_back(it->path().filename().string());
    it.increment(error);
  }
  std::sort(names.begin(), names.end());  // the order on disk is arbitrary
  return did_you_mean(full.filename().string(), names);
}

class Disk {
 public:
  Disk(const std::string& folder, SourceMap& sources) : folder_(folder), sources_(&sources) {}

  // Links are resolved first, then the place that they lead to is judged.
  Expected<fs::path> resolve(const std::string& path) const {
    const auto refuse = [&](const std::string& why) {
      return unexpected(
          make_error("machine_invalid", "can't use the file '" + printable(path) + "': " + why));
    };
    if (const auto problem = problem_of(path)) return refuse(*problem);
    std::error_code error;
    const fs::path root = fs::canonical(folder_, error);
    if (error) return refuse("the package's folder is gone");
    const fs::path full = fs::canonical(root / path, error);
    if (error) return refuse("there is no such file." + suggestion(root / path));
    const auto ends = std::mismatch(root.begin(), root.end(), full.begin(), full.end());
    if (ends.first != root.end()) return refuse("a link leads out of the package's folder");
    if (!fs::is_regular_file(full, error)) return refuse("it is not a regular file");
    return full;
  }

  Expected<std::shared_ptr<const TriangleMesh>> mesh(const std::string& path,
                                                     const MeshFileOptions& options) {
    const auto full = resolve(path);
    if (!full) return unexpected(full.error());
    auto& slot = meshes_[{full->string(), options.unit_mm, options.y_up}];
    if (slot) return slot;
    // Named as the user wrote it, so that messages don't depend on where the package is.
    auto mesh = read_mesh((fs::path(folder_) / path).string(), options);
    if (!mesh) return unexpected(mesh.error());
    slot = std::make_shared<const TriangleMesh>(std::move(*mesh));
    return slot;
  }

  Expected<const SourceText*> text(const std::string& path) const {
    const auto full = resolve(path);
    if (!full) return unexpected(full.error());
    return sources_->open((fs::path(folder_) / path).string());
  }

  Expected<std::string> full_path(const std::string& path) const {
    const auto full = resolve(path);
    if (!full) return unexpected(full.error());
    return (fs::path(folder_) / path).string();
  }

 private:
  std::string folder_;
  SourceMap* sources_;
  std::map<std::tuple<std::string, double, bool>, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace

PackageFiles disk_files(const std::string& folder, SourceMap& sources) {
  const auto disk = std::make_shared<Disk>(folder.empty() ? "." : folder, sources);
  PackageFiles files;
  files.mesh = [disk](const std::string& path, const MeshFileOptions& options) {
    return disk->mesh(path, options);
  };
  files.text = [disk](const std::string& path) { return disk->text(path); };
  files.full_path = [disk](const std::string& path) { return disk->full_path(path); };
  return files;
}

}  // namespace aircut::machine
