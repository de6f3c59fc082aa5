// Import of OBJ, COLLADA, glTF and 3MF through assimp, with its reach cut down.
//
// Only the importer of the file's extension stays registered. All files go through an IOSystem of
// our own: the main file is in memory already; a file that it names (OBJ materials, glTF buffers)
// is opened only if, after opening, it turns out to be a regular file inside the main file's
// folder, and as long as the sum of all bytes stays within the limit. Since the importer
// crashes and hangs on some broken files, it runs in a child process. No exception leaves this
// file.
//
// The scene's nodes form a tree of poses; a mesh may hang on several nodes. Poses that mirror turn
// the triangles over, so that outside stays outside. glTF and COLLADA scenes come out in metres
// (COLLADA's own unit sits in the root's matrix).
#include "geometry/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "geometry/child.h"
#include "geometry/zip.h"

namespace aircut::geometry {
namespace {

/// A file in memory.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string own) : own_(std::move(own)), bytes_(own_) {}
  explicit MemoryStream(std::string_view borrowed) : bytes_(borrowed) {}

  std::size_t Read(void* out, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(out, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t base = 0;
    if (origin == aiOrigin_CUR) base = at_;
    if (origin == aiOrigin_END) base = bytes_.size();
    const std::size_t target = base + offset;  // wraps for offsets below zero, as meant
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string own_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// A descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// Lets the importer see the main file and its folder.
class FolderSystem final : public Assimp::IOSystem {
 public:
  FolderSystem(const ImportSource& source, std::size_t max_bytes)
      : source_(source), left_(max_bytes - std::min(max_bytes, source.bytes.size())) {}

  bool Exists(const char* file) const override {
    return is_main(file) || companion(file, left_).has_value();
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (mode == nullptr || *mode != 'r') return nullptr;
    if (is_main(file)) return new MemoryStream(source_.bytes);
    auto bytes = companion(file, left_);
    if (!bytes) return nullptr;
    left_ -= bytes->size();
    return new MemoryStream(std::move(*bytes));
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  bool is_main(const char* file) const { return file != nullptr && source_.name == file; }

  /// The bytes of another file of the folder, or nothing if it isn't one or is too large.
  std::optional<std::string> companion(const char* file, std::size_t limit) const {
    namespace fs = std::filesystem;
    if (file == nullptr || *file == '\0' || source_.folder.empty()) return std::nullopt;
    std::error_code error;
    const fs::path root = fs::canonical(source_.folder, error);
    if (error || fs::path(file).is_absolute()) return std::nullopt;
    const Descriptor fd(::open((root / file).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    struct stat info {};
    if (fd.get() < 0 || ::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode))
      return std::nullopt;
    // Decided by what was opened, not by what was asked for: links may lead anywhere.
    const fs::path real = fs::read_symlink(fmt::format("/proc/self/fd/{}", fd.get()), error);
    const auto end = std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first;
    if (error || end != root.end()) return std::nullopt;
    if (static_cast<std::uint64_t>(info.st_size) > limit) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(info.st_size), '\0');
    std::size_t have = 0;
    while (have < bytes.size()) {
      const ssize_t got = ::read(fd.get(), bytes.data() + have, bytes.size() - have);
      if (got <= 0) return std::nullopt;
      have += static_cast<std::size_t>(got);
    }
    return bytes;
  }

  const ImportSource& source_;
  std::size_t left_;
};

/// Takes out every importer that isn't for `extension`; the rest of the code is never reached.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* info = importer.GetImporterInfo(i);
    const std::string words = info != nullptr ? fmt::format(" {} ", info->mFileExtensions) : "";
    if (words.find(" " + extension + " ") != std::string::npos) continue;
    // Whoever takes an importer out owns it from then on.
    const std::unique_ptr<Assimp::BaseImporter> taken_out(importer.GetImporter(i));
    importer.UnregisterLoader(taken_out.get());
  }
}

bool mirrors(const aiMatrix4x4& m) { return m.Determinant() < 0; }

/// Collects the triangles of a scene.
class Collector {
 public:
  Collector(const aiScene& scene, double unit, std::size_t max_triangles)
      : scene_(scene), unit_(unit), max_triangles_(max_triangles) {}

  tl::expected<TriangleMesh, std::string> collect() {
    // An explicit stack: files can nest nodes deeper than ours goes.
    std::vector<std::pair<const aiNode*, aiMatrix4x4>> open = {{scene_.mRootNode, aiMatrix4x4()}};
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      if (node == nullptr) continue;
      const aiMatrix4x4 pose = parent * node->mTransformation;
      for (unsigned i = 0; i < node->mNumMeshes; ++i)
        if (auto ok = add(node->mMeshes[i], pose); !ok) return unexpected(ok.error());
      for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], pose);
    }
    return std::move(mesh_);
  }

 private:
  tl::expected<void, std::string> add(unsigned number, const aiMatrix4x4& m) {
    if (number >= scene_.mNumMeshes || scene_.mMeshes[number] == nullptr) return {};
    const aiMesh& part = *scene_.mMeshes[number];
    if (part.mVertices == nullptr || part.mFaces == nullptr) return {};
    if (mesh_.vertices.size() + part.mNumVertices > 0xfffffff0u)
      return unexpected(std::string("has more vertices than can be numbered"));
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D v = part.mVertices[i];
      const double x = static_cast<double>(v.x), y = static_cast<double>(v.y),
                   z = static_cast<double>(v.z);
      const auto row = [&](ai_real a, ai_real b, ai_real c, ai_real d) {
        return unit_ * (static_cast<double>(a) * x + static_cast<double>(b) * y +
                        static_cast<double>(c) * z + static_cast<double>(d));
      };
      mesh_.vertices.emplace_back(row(m.a1, m.a2, m.a3, m.a4), row(m.b1, m.b2, m.b3, m.b4),
                                  row(m.c1, m.c2, m.c3, m.c4));
    }
    const bool turn = mirrors(m);
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices < 3) continue;  // points and lines have no surface
      std::array<std::uint32_t, 3> t{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          return unexpected(std::string("has a face with a vertex that doesn't exist"));
        t[k] = first + face.mIndices[k];
      }
      if (turn) std::swap(t[1], t[2]);
      if (mesh_.triangles.size() == max_triangles_)
        return unexpected(fmt::format("has more triangles than the limit of {}", max_triangles_));
      mesh_.triangles.push_back(t);
    }
    return {};
  }

  const aiScene& scene_;
  double unit_;
  std::size_t max_triangles_;
  TriangleMesh mesh_;
};

/// Length of a 3MF model's unit in mm, which the importer leaves out. Refuses archives that unpack
/// to more than the limit.
tl::expected<double, std::string> unit_of_3mf(std::string_view archive, std::size_t max_bytes) {
  const auto entries = zip_entries(archive);
  if (!entries)
    return unexpected(std::string("is no 3MF file: its zip directory is missing or broken"));
  std::uint64_t total = 0;
  for (const ZipEntry& entry : *entries) total += entry.unpacked;
  if (total > max_bytes)
    return unexpected(
        fmt::format("would unpack to {} bytes, more than the limit of {}", total, max_bytes));
  const auto is_model = [](const ZipEntry& entry) { return entry.name.ends_with(".model"); };
  const auto model = std::find_if(entries->begin(), entries->end(), is_model);
  if (model == entries->end()) return unexpected(std::string("has no 3D model in its archive"));
  constexpr std::size_t enough = 16'384;  // the model's element stands near the start
  const auto start = unpack_start(archive, *model, enough);
  if (!start) return unexpected(std::string("has a model that can't be unpacked"));
  const std::size_t begin = start->find("<model");
  if (begin == std::string::npos) return unexpected(std::string("has no <model> in its archive"));
  const std::string tag = start->substr(begin, start->find('>', begin) - begin);
  const std::size_t unit = tag.find(" unit=");
  if (unit == std::string::npos) return 1.0;  // the format's default is the millimetre
  const std::size_t open = unit + 6;
  const std::size_t close = open < tag.size() ? tag.find(tag[open], open + 1) : std::string::npos;
  const std::string word =
      close == std::string::npos ? std::string() : tag.substr(open + 1, close - open - 1);
  constexpr std::pair<std::string_view, double> units[] = {{"micron", 0.001},  {"millimeter", 1},
                                                           {"centimeter", 10}, {"inch", 25.4},
                                                           {"foot", 304.8},    {"meter", 1000}};
  for (const auto& [name, mm] : units)
    if (word == name) return mm;
  return unexpected(fmt::format("has the unknown unit '{}'", printable(word)));
}

tl::expected<TriangleMesh, std::string> import_or_throw(const ImportSource& source,
                                                        const MeshFileOptions& options) {
  double unit = 1;
  if (source.extension == "gltf" || source.extension == "glb" || source.extension == "dae")
    unit = 1000;  // the scene is in metres
  if (source.extension == "3mf") {
    const auto stated = unit_of_3mf(source.bytes, options.max_bytes);
    if (!stated) return unexpected(stated.error());
    unit = *stated;
  }
  Assimp::Importer importer;
  keep_only(importer, source.extension);
  importer.SetIOHandler(new FolderSystem(source, options.max_bytes));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFile(source.name, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string why = printable(importer.GetErrorString());
    return unexpected(fmt::format("can't be read as {}: {}", source.extension,
                                  why.empty() ? "the importer gives no reason" : why));
  }
  return Collector(*scene, unit, options.max_triangles).collect();
}

tl::expected<TriangleMesh, std::string> import_without_throwing(const ImportSource& source,
                                                                const MeshFileOptions& options) {
  try {
    return import_or_throw(source, options);
  } catch (const std::bad_alloc&) {
    return unexpected(std::string("needs more memory than there is"));
  } catch (const std::exception& error) {
    return unexpected(fmt::format("can't be read: {}", printable(error.what())));
  } catch (...) {
    return unexpected(std::string("can't be read: the importer gave up without a reason"));
  }
}

// From the child: 'e' and the error, or 'm', the two counts, vertices, triangles as they lie in
// memory.

template <class T>
void put(std::string& out, const T* values, std::size_t count) {
  out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string packed(const tl::expected<TriangleMesh, std::string>& result) {
  if (!result) return "e" + result.error();
  std::string out = "m";
  const std::array<std::uint64_t, 2> counts = {result->vertices.size(), result->triangles.size()};
  put(out, counts.data(), counts.size());
  put(out, result->vertices.data(), counts[0]);
  put(out, result->triangles.data(), counts[1]);
  return out;
}

tl::expected<TriangleMesh, std::string> unpacked(const std::string& bytes) {
  if (bytes.starts_with('e')) return unexpected(bytes.substr(1));
  TriangleMesh mesh;
  using Corners = decltype(mesh.triangles)::value_type;
  std::array<std::uint64_t, 2> counts{};
  constexpr std::size_t head = 1 + sizeof(counts);
  if (bytes.size() >= head) std::memcpy(counts.data(), bytes.data() + 1, sizeof(counts));
  if (bytes.size() < head ||
      bytes.size() - head != counts[0] * sizeof(Vec3) + counts[1] * sizeof(Corners))
    return unexpected(std::string("can't be read: the importer gave half a result"));
  mesh.vertices.resize(counts[0]);
  mesh.triangles.resize(counts[1]);
  const char* at = bytes.data() + head;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i, at += sizeof(Vec3))
    std::memcpy(mesh.vertices[i].data(), at, sizeof(Vec3));
  if (!mesh.triangles.empty())
    std::memcpy(mesh.triangles.data(), at, mesh.triangles.size() * sizeof(Corners));
  return mesh;
}

}  // namespace

tl::expected<TriangleMesh, std::string> import_mesh(const ImportSource& source,
                                                    const MeshFileOptions& options) {
  const auto bytes =
      run_in_child([&] { return packed(import_without_throwing(source, options)); }, ChildLimits{});
  if (!bytes)
    return unexpected(fmt::format("can't be read as {}: the importer failed, {}", source.extension,
                                  bytes.error()));
  return unpacked(*bytes);
}

}  // namespace aircut::geometry
