// Reading of mesh files: opening, the choice of the reader, units, axes, and the checks that hold
// for every format. STL is read by our own reader (stl.cpp), the rest through assimp
// (mesh_import.cpp).
#include "geometry/mesh_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "geometry/mesh_import.h"
#include "geometry/ply.h"
#include "geometry/stl.h"

namespace aircut {
namespace {

constexpr std::array<std::string_view, 7> known_extensions = {"stl",  "obj", "ply", "dae",
                                                              "gltf", "glb", "3mf"};
/// A thousand kilometres; beyond it squares of lengths lose the micrometre. mm.
constexpr double largest_coordinate = 1e9;

Diagnostic invalid(const std::string& path, const std::string& what) {
  return make_error("mesh_invalid", fmt::format("mesh '{}' {}", printable(path), what));
}

std::string extension_of(const std::string& path) {
  std::string out = std::filesystem::path(path).extension().string();
  if (!out.empty()) out.erase(0, 1);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

bool is_known(const std::string& extension) {
  return std::find(known_extensions.begin(), known_extensions.end(), extension) !=
         known_extensions.end();
}

std::string unknown_format(const std::string& extension) {
  return fmt::format("{}; use STL, OBJ, PLY, COLLADA (.dae), glTF (.gltf, .glb) or 3MF",
                     extension.empty()
                         ? "has no extension that says its format"
                         : fmt::format("is of no known format ('.{}')", printable(extension)));
}

/// A file's whole content. Errors are sentences that go after the file's name.
tl::expected<std::string, std::string> file_bytes(const std::string& path, std::size_t max_bytes) {
  // O_NONBLOCK: a pipe must not make us wait.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    if (errno == ENOENT || errno == ENOTDIR) return unexpected(std::string("does not exist"));
    return unexpected(fmt::format("can't be opened: {}", std::strerror(errno)));
  }
  const auto finish = [&](tl::expected<std::string, std::string> result) {
    ::close(fd);
    return result;
  };
  struct stat info {};
  if (::fstat(fd, &info) != 0)
    return finish(unexpected(fmt::format("can't be opened: {}", std::strerror(errno))));
  if (S_ISDIR(info.st_mode))
    return finish(unexpected(std::string("is a folder; name the mesh file in it")));
  if (!S_ISREG(info.st_mode)) return finish(unexpected(std::string("is not a regular file")));
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes)
    return finish(
        unexpected(fmt::format("has {} bytes, more than the limit of {}", size, max_bytes)));
  std::string bytes(size, '\0');
  std::size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t got = ::read(fd, bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return finish(unexpected(fmt::format("can't be read: {}", std::strerror(errno))));
    if (got == 0) return finish(unexpected(std::string("became shorter while it was read")));
    have += static_cast<std::size_t>(got);
  }
  return finish(std::move(bytes));
}

bool states_its_unit(const std::string& extension) {
  return extension == "gltf" || extension == "glb" || extension == "dae" || extension == "3mf";
}

tl::expected<TriangleMesh, std::string> triangles_of(std::string_view bytes,
                                                     const std::string& extension,
                                                     const std::string& folder,
                                                     const MeshFileOptions& options) {
  if (extension == "stl") return geometry::read_stl(bytes, options.max_triangles);
  if (extension == "ply") return geometry::read_ply(bytes, options.max_triangles);
  return geometry::import_mesh(
      {.bytes = bytes, .name = "mesh." + extension, .extension = extension, .folder = folder},
      options);
}

Expected<TriangleMesh> read(std::string_view bytes, const std::string& path,
                            const std::string& folder, const MeshFileOptions& options) {
  const std::string extension = extension_of(path);
  if (!is_known(extension)) return unexpected(invalid(path, unknown_format(extension)));
  if (bytes.size() > options.max_bytes)
    return unexpected(invalid(path, fmt::format("has {} bytes, more than the limit of {}",
                                                bytes.size(), options.max_bytes)));
  if (bytes.empty()) return unexpected(invalid(path, "is empty"));

  auto raw = triangles_of(bytes, extension, folder, options);
  if (!raw) return unexpected(invalid(path, raw.error()));

  const double unit = states_its_unit(extension) ? 1.0 : options.unit_mm;
  for (Vec3& v : raw->vertices) {
    v *= unit;
    if (options.y_up) v = Vec3(v.x(), -v.z(), v.y());
    if (!v.allFinite()) return unexpected(invalid(path, "has a coordinate that is not a number"));
    if (v.cwiseAbs().maxCoeff() > largest_coordinate)
      return unexpected(invalid(path, "has a coordinate beyond 1000 km; check its unit"));
  }
  TriangleMesh mesh = welded(*raw);
  if (mesh.empty()) return unexpected(invalid(path, "has no triangles with an area"));
  return mesh;
}

}  // namespace

Expected<TriangleMesh> read_mesh(const std::string& path, const MeshFileOptions& options) {
  auto bytes = file_bytes(path, options.max_bytes);
  if (!bytes) return unexpected(invalid(path, bytes.error()));
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return read(*bytes, path, folder.empty() ? "." : folder, options);
}

Expected<TriangleMesh> read_mesh_bytes(std::string_view bytes, const std::string& name,
                                       const MeshFileOptions& options) {
  return read(bytes, name, "", options);
}

}  // namespace aircut
