// PLY with values and colours for each vertex.
#include <bit>

#include "report/deviation.h"

namespace aircut::report {

std::string ply_bytes(const TriangleMesh& mesh, std::span<const double> quality,
                      std::span<const std::array<std::uint8_t, 3>> colors) {
  std::string out =
      "ply\nformat binary_little_endian 1.0\ncomment aircut, mm\nelement vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](std::uint32_t value) {
    for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(value >> (8 * byte) & 255);
  };
  const auto number = [&](double v) { put(std::bit_cast<std::uint32_t>(static_cast<float>(v))); };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int a = 0; a < 3; ++a) number(mesh.vertices[i][a]);
    number(quality[i]);
    for (const std::uint8_t part : colors[i]) out += static_cast<char>(part);
  }
  for (const auto& triangle : mesh.triangles) {
    out += static_cast<char>(3);
    for (const std::uint32_t corner : triangle) put(corner);
  }
  return out;
}

}  // namespace aircut::report
