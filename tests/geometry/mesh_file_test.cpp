#include "geometry/mesh_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "geometry/geometry.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed afterwards.
class MeshFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              fmt::format("aircut_mesh_{}_{}", test->name(), static_cast<long>(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string put(const std::string& name, const std::string& bytes) {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    EXPECT_TRUE(write_file(path.string(), bytes));
    return path.string();
  }
  fs::path folder_;
};

std::string error_of(const Expected<TriangleMesh>& result) {
  if (result) return "(no error)";
  EXPECT_EQ(result.error().kind, "mesh_invalid");
  return result.error().message;
}

#define EXPECT_SAYS(result, words) \
  EXPECT_NE(error_of(result).find(words), std::string::npos) << error_of(result)

const TriangleMesh box = make_box({-1, -2, -3}, {4, 5, 6});

std::string text_stl() {
  std::string out = "solid box\n";
  for (const auto& t : box.triangles) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (const auto v : t)
      out += fmt::format("  vertex {} {} {}\n", box.vertices[v].x(), box.vertices[v].y(),
                         box.vertices[v].z());
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid box\n";
}

std::string obj_text() {
  std::string out;
  for (const Vec3& v : box.vertices) out += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& t : box.triangles)
    out += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return out;
}

std::string ply_text() {
  std::string out =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : box.vertices) out += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& t : box.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

/// `unit` in metres; the box hangs on a node with `matrix`.
std::string collada_text(const std::string& unit, const std::string& up,
                         const std::string& matrix) {
  std::string positions, indices;
  for (const Vec3& v : box.vertices) positions += fmt::format("{} {} {} ", v.x(), v.y(), v.z());
  for (const auto& t : box.triangles) indices += fmt::format("{} {} {} ", t[0], t[1], t[2]);
  return fmt::format(
      R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{}"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="24">{}</float_array><technique_common>
<accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>{}</matrix><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)",
      unit, up, positions, indices, matrix);
}

template <class T>
void put_raw(std::string& out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  out.append(raw, sizeof(T));
}

std::string gltf_buffer() {
  std::string buffer;
  for (const Vec3& v : box.vertices)
    for (int c = 0; c < 3; ++c) put_raw(buffer, static_cast<float>(v[c] / 1000));
  for (const auto& t : box.triangles)
    for (const auto v : t) put_raw(buffer, static_cast<std::uint16_t>(v));
  return buffer;
}

std::string gltf_text(const std::string& buffer_field, const std::string& node_fields) {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0{}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"buffers":[{{{}"byteLength":168}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[-0.001,-0.002,-0.003],"max":[0.004,0.005,0.006]}},
{{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}]}})",
      node_fields, buffer_field);
}

std::string glb_bytes(const std::string& node_fields) {
  std::string json = gltf_text("", node_fields);
  while (json.size() % 4 != 0) json += ' ';
  const std::string buffer = gltf_buffer();
  std::string out = "glTF";
  put_raw(out, std::uint32_t{2});
  put_raw(out, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
  put_raw(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put_raw(out, static_cast<std::uint32_t>(buffer.size()));
  out += std::string("BIN\0", 4) + buffer;
  return out;
}

std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// A zip archive without compression. `claimed` is the unpacked size that the directory claims
/// instead of the true one when it isn't 0.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files,
                   std::uint32_t claimed = 0) {
  std::string out, directory;
  for (const auto& [name, bytes] : files) {
    const auto at = static_cast<std::uint32_t>(out.size());
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::string common;
    put_raw(common, std::uint16_t{20});
    put_raw(common, std::uint16_t{0});
    put_raw(common, std::uint16_t{0});
    put_raw(common, std::uint32_t{0});
    put_raw(common, crc32(bytes));
    put_raw(common, size);
    put_raw(common, claimed != 0 ? claimed : size);
    put_raw(common, static_cast<std::uint16_t>(name.size()));
    put_raw(common, std::uint16_t{0});
    out += "PK\3\4" + common + name + bytes;
    directory += "PK\1\2";
    put_raw(directory, std::uint16_t{20});
    directory += common;
    put_raw(directory, std::uint16_t{0});
    put_raw(directory, std::uint16_t{0});
    put_raw(directory, std::uint16_t{0});
    put_raw(directory, std::uint32_t{0});
    put_raw(directory, at);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(out.size());
  out += directory + "PK\5\6";
  put_raw(out, std::uint32_t{0});
  put_raw(out, static_cast<std::uint16_t>(files.size()));
  put_raw(out, static_cast<std::uint16_t>(files.size()));
  put_raw(out, static_cast<std::uint32_t>(directory.size()));
  put_raw(out, start);
  put_raw(out, std::uint16_t{0});
  return out;
}

std::string threemf_bytes(const std::string& unit, std::uint32_t claimed = 0) {
  std::string model = fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="{}" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh><vertices>)",
      unit);
  for (const Vec3& v : box.vertices)
    model += fmt::format(R"(<vertex x="{}" y="{}" z="{}"/>)", v.x(), v.y(), v.z());
  model += "</vertices><triangles>";
  for (const auto& t : box.triangles)
    model += fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}"/>)", t[0], t[1], t[2]);
  model += R"(</triangles></mesh></object></resources><build><item objectid="1"/></build></model>)";
  const std::string rels =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";
  const std::string types =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)";
  return zip_of(
      {{"[Content_Types].xml", types}, {"_rels/.rels", rels}, {"3D/3dmodel.model", model}},
      claimed);
}

void expect_box(const Expected<TriangleMesh>& result, const Vec3& low, const Vec3& high) {
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->triangles.size(), 12u);
  EXPECT_EQ(result->vertices.size(), 8u);
  EXPECT_LT((bounds(*result).min() - low).norm(), 1e-5) << bounds(*result).min().transpose();
  EXPECT_LT((bounds(*result).max() - high).norm(), 1e-5) << bounds(*result).max().transpose();
  EXPECT_NEAR(volume(*result) / (high - low).prod(), 1, 1e-6);
}
void expect_box(const Expected<TriangleMesh>& result) {
  expect_box(result, {-1, -2, -3}, {4, 5, 6});
}

TEST_F(MeshFile, ReadsBinaryStl) { expect_box(read_mesh(put("b.stl", stl_bytes(box)))); }
TEST_F(MeshFile, ReadsTextStl) { expect_box(read_mesh(put("b.STL", text_stl()))); }
TEST_F(MeshFile, ReadsBinaryStlWhoseHeaderSaysSolid) {
  std::string bytes = stl_bytes(box);
  bytes.replace(0, 5, "solid");
  expect_box(read_mesh(put("b.stl", bytes)));
}
TEST_F(MeshFile, ReadsObj) { expect_box(read_mesh(put("b.obj", obj_text()))); }
TEST_F(MeshFile, ReadsPly) { expect_box(read_mesh(put("b.ply", ply_text()))); }
TEST_F(MeshFile, ReadsGlbInMetresAsMillimetres) {
  expect_box(read_mesh(put("b.glb", glb_bytes(""))));
}
TEST_F(MeshFile, ReadsGltfWithABufferBesideIt) {
  put("b.bin", gltf_buffer());
  expect_box(read_mesh(put("b.gltf", gltf_text(R"("uri":"b.bin",)", ""))));
}
TEST_F(MeshFile, ReadsColladaInItsOwnUnitAndAxes) {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
  expect_box(read_mesh(put("b.dae", collada_text("0.001", "Z_UP", identity))));
  expect_box(read_mesh(put("y.dae", collada_text("0.001", "Y_UP", identity))));
  expect_box(read_mesh(put("i.dae", collada_text("0.0254", "Z_UP", identity))),
             25.4 * Vec3(-1, -2, -3), 25.4 * Vec3(4, 5, 6));
}
TEST_F(MeshFile, Reads3mf) { expect_box(read_mesh(put("b.3mf", threemf_bytes("millimeter")))); }
TEST_F(MeshFile, Reads3mfInItsOwnUnit) {
  expect_box(read_mesh(put("b.3mf", threemf_bytes("inch"))), 25.4 * Vec3(-1, -2, -3),
             25.4 * Vec3(4, 5, 6));
}

TEST_F(MeshFile, AppliesNodeTransforms) {
  expect_box(
      read_mesh(put("b.dae", collada_text("0.001", "Z_UP", "1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1"))),
      {9, 18, 27}, {14, 25, 36});
  expect_box(read_mesh(put("b.glb", glb_bytes(R"(,"translation":[0.1,0,0])"))), {99, -2, -3},
             {104, 5, 6});
}
TEST_F(MeshFile, KeepsOutsideOutsideUnderAMirror) {
  expect_box(read_mesh(put("b.glb", glb_bytes(R"(,"scale":[-1,1,1])"))), {-4, -2, -3}, {1, 5, 6});
}
TEST_F(MeshFile, ScalesByTheUnit) {
  expect_box(read_mesh(put("b.stl", stl_bytes(box)), {.unit_mm = 25.4}), 25.4 * Vec3(-1, -2, -3),
             25.4 * Vec3(4, 5, 6));
}
TEST_F(MeshFile, LeavesTheUnitOfFormatsThatStateIt) {
  expect_box(read_mesh(put("b.glb", glb_bytes("")), {.unit_mm = 25.4}));
}
TEST_F(MeshFile, TurnsYUpToZUp) {
  expect_box(read_mesh(put("b.obj", obj_text()), {.y_up = true}), {-1, -6, -2}, {4, 3, 5});
}
TEST_F(MeshFile, ReadsTheSameFromMemory) {
  expect_box(read_mesh_bytes(stl_bytes(box), "x.stl"));
  expect_box(read_mesh_bytes(obj_text(), "x.obj"));
}

TEST_F(MeshFile, SaysThatAFileIsMissing) {
  EXPECT_SAYS(read_mesh((folder_ / "none.stl").string()), "does not exist");
}
TEST_F(MeshFile, SaysThatAPathIsAFolder) {
  fs::create_directories(folder_ / "f.stl");
  EXPECT_SAYS(read_mesh((folder_ / "f.stl").string()), "is a folder");
}
TEST_F(MeshFile, RefusesAPipeWithoutWaiting) {
  const std::string path = (folder_ / "p.stl").string();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_SAYS(read_mesh(path), "not a regular file");
}
TEST_F(MeshFile, SaysWhichFormatsThereAre) {
  EXPECT_SAYS(read_mesh(put("b.step", "ISO-10303-21;")), "'.step'");
  EXPECT_SAYS(read_mesh(put("noext", "x")), "no extension");
}
TEST_F(MeshFile, RefusesEmptyFilesAndMeshes) {
  EXPECT_SAYS(read_mesh(put("e.stl", "")), "is empty");
  EXPECT_SAYS(read_mesh(put("s.stl", "solid x\nendsolid x\n")), "no triangles");
  EXPECT_SAYS(read_mesh(put("z.stl", stl_bytes({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}))),
              "no triangles");
}
TEST_F(MeshFile, RefusesTruncatedStl) {
  const std::string bytes = stl_bytes(box);
  EXPECT_SAYS(read_mesh(put("t.stl", bytes.substr(0, bytes.size() - 20))), "truncated");
  EXPECT_SAYS(read_mesh(put("l.stl", bytes + "xx")), "too long");
  EXPECT_SAYS(read_mesh(put("h.stl", bytes.substr(0, 50))), "50 bytes");
  const std::string text = text_stl();
  EXPECT_SAYS(read_mesh(put("a.stl", text.substr(0, text.size() / 2))), "line ");
  EXPECT_SAYS(read_mesh(put("n.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 z 3\n")),
              "line 4 should have a coordinate where 'z' is");
}
TEST_F(MeshFile, RefusesTruncatedFilesOfEveryFormat) {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
  const std::pair<const char*, std::string> files[] = {
      {"t.ply", ply_text()},
      {"t.dae", collada_text("0.001", "Z_UP", identity)},
      {"t.glb", glb_bytes("")},
      {"t.3mf", threemf_bytes("millimeter")}};
  for (const auto& [name, bytes] : files)
    for (const double share : {0.1, 0.5, 0.9, 0.97}) {
      const auto size = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
      EXPECT_NE(error_of(read_mesh(put(name, bytes.substr(0, size)))), "(no error)")
          << name << " " << share;
    }
}
TEST_F(MeshFile, RefusesWhatIsNoNumber) {
  TriangleMesh bad = box;
  bad.vertices[3].y() = std::nan("");
  EXPECT_SAYS(read_mesh(put("n.stl", stl_bytes(bad))), "not a number");
  bad.vertices[3].y() = HUGE_VAL;
  EXPECT_SAYS(read_mesh(put("i.stl", stl_bytes(bad))), "not a number");
  bad.vertices[3].y() = 1e30;
  EXPECT_SAYS(read_mesh(put("l.stl", stl_bytes(bad))), "beyond 1000 km");
}
TEST_F(MeshFile, KeepsToItsLimits) {
  const std::string path = put("b.stl", stl_bytes(box));
  EXPECT_SAYS(read_mesh(path, {.max_bytes = 100}), "limit of 100");
  EXPECT_SAYS(read_mesh(path, {.max_triangles = 11}), "limit of 11");
  EXPECT_SAYS(read_mesh(put("t.stl", text_stl()), {.max_triangles = 11}), "limit of 11");
  EXPECT_SAYS(read_mesh(put("b.obj", obj_text()), {.max_triangles = 11}), "limit of 11");
}
TEST_F(MeshFile, RefusesAnArchiveThatUnpacksToTooMuch) {
  EXPECT_SAYS(read_mesh(put("b.3mf", threemf_bytes("millimeter", 0xf0000000u))), "unpack");
}
TEST_F(MeshFile, DoesNotOpenFilesOutsideItsFolder) {
  const std::string buffer = put("secret.bin", gltf_buffer());
  const std::string outside = put("in/b.gltf", gltf_text(R"("uri":"../secret.bin",)", ""));
  EXPECT_NE(error_of(read_mesh(outside)), "(no error)");
  const std::string absolute =
      put("in/c.gltf", gltf_text(fmt::format(R"("uri":"{}",)", buffer), ""));
  EXPECT_NE(error_of(read_mesh(absolute)), "(no error)");
  fs::create_symlink(buffer, folder_ / "in/link.bin");
  const std::string link = put("in/d.gltf", gltf_text(R"("uri":"link.bin",)", ""));
  EXPECT_NE(error_of(read_mesh(link)), "(no error)");
  fs::copy_file(buffer, folder_ / "in/inside.bin");
  expect_box(read_mesh(put("in/e.gltf", gltf_text(R"("uri":"inside.bin",)", ""))));
}
TEST_F(MeshFile, SaysWhatIsWrongWithAFileThatIsNoMesh) {
  for (const char* name : {"x.obj", "x.ply", "x.dae", "x.gltf", "x.glb", "x.3mf", "x.stl"})
    EXPECT_NE(error_of(read_mesh(put(name, "this is no mesh\n"))), "(no error)") << name;
}

}  // namespace
}  // namespace aircut
