// Rounds: every edge that is too long gets its middle as a vertex, for both of its triangles, and a
// triangle becomes two, three or four by how many of its edges have one. An edge halves each round,
// so the rounds are as many as the logarithm of the longest.
#include "geometry/split_edges.h"

#include <algorithm>
#include <map>

namespace aircut {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(const Triangle& t, std::size_t i) { return std::minmax(t[i], t[(i + 1) % 3]); }

// `middle[i]`: the vertex on the edge from corner i to the next, if that is split.
void split(const Triangle& t, const std::array<const std::uint32_t*, 3>& middle,
           std::vector<Triangle>& out) {
  const auto count = std::count_if(middle.begin(), middle.end(), [](auto* m) { return m; });
  if (count == 0) return out.push_back(t);
  if (count == 3) {
    for (std::size_t i = 0; i < 3; ++i) out.push_back({t[i], *middle[i], *middle[(i + 2) % 3]});
    return out.push_back({*middle[0], *middle[1], *middle[2]});
  }
  // Turned so that the first edge is split and, of two, the second as well.
  std::size_t first = 0;
  while (!middle[first] || (count == 2 && !middle[(first + 1) % 3])) ++first;
  const std::uint32_t a = t[first], b = t[(first + 1) % 3], c = t[(first + 2) % 3];
  const std::uint32_t ab = *middle[first];
  if (count == 1) {
    out.push_back({a, ab, c});
    return out.push_back({ab, b, c});
  }
  const std::uint32_t bc = *middle[(first + 1) % 3];
  out.push_back({ab, b, bc});
  out.push_back({a, ab, bc});
  out.push_back({a, bc, c});
}

}  // namespace

TriangleMesh with_short_edges(TriangleMesh mesh, double longest, std::size_t most) {
  while (mesh.triangles.size() <= most / 4) {
    std::map<Edge, std::uint32_t> middles;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_of(t, i);
        const Vec3 &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
        if ((b - a).norm() <= longest) continue;
        if (middles.try_emplace(edge, static_cast<std::uint32_t>(mesh.vertices.size())).second)
          mesh.vertices.push_back(0.5 * (a + b));
      }
    if (middles.empty()) return mesh;
    std::vector<Triangle> all;
    all.reserve(2 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      std::array<const std::uint32_t*, 3> middle{};
      for (std::size_t i = 0; i < 3; ++i)
        if (const auto found = middles.find(edge_of(t, i)); found != middles.end())
          middle[i] = &found->second;
      split(t, middle, all);
    }
    mesh.triangles = std::move(all);
  }
  return mesh;
}

}  // namespace aircut
