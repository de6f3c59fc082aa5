// Any bytes as a mesh file: the first byte chooses the format, the rest is the content.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "geometry/geometry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<const char*, 7> names = {"m.stl",  "m.ply", "m.obj", "m.dae",
                                                       "m.gltf", "m.glb", "m.3mf"};
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto mesh = aircut::read_mesh_bytes(bytes, names[data[0] % names.size()],
                                            {.max_triangles = 100'000, .max_bytes = 1'000'000});
  if (!mesh) {
    if (mesh.error().kind != "mesh_invalid" || mesh.error().message.empty()) std::abort();
    return 0;
  }
  // What was read must hold together.
  if (mesh->empty()) std::abort();
  for (const auto& triangle : mesh->triangles)
    for (const auto v : triangle)
      if (v >= mesh->vertices.size()) std::abort();
  std::size_t triangles = 0;
  for (const aircut::Shell& shell : aircut::shells(*mesh)) triangles += shell.triangles.size();
  if (triangles != mesh->triangles.size()) std::abort();
  return 0;
}
