// The border of a surface is the sum of its triangles' directed edges: an edge that two triangles
// run along in opposite directions cancels out. What is left is cut at the vertices that lie on it,
// so that a long edge cancels with the short ones of a T-junction; a surface has no border if
// nothing remains.
#include "machine/mesh_check.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace aircut::machine {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Sum = std::map<Edge, int>;  // by (low, high): how often forward minus how often backward

void add(Sum& sum, std::uint32_t from, std::uint32_t to, int times) {
  if (from > to) {
    std::swap(from, to);
    times = -times;
  }
  sum[{from, to}] += times;
}

// Cuts an edge at those of `candidates` that lie on it.
std::vector<std::uint32_t> cut(const TriangleMesh& mesh, const Edge& edge,
                               const std::vector<std::uint32_t>& candidates) {
  constexpr double on_line_mm = 1e-4;  // a 32 bit file rounds positions of 1 m to 3e-5 mm
  const Vec3& a = mesh.vertices[edge.first];
  const Vec3 way = mesh.vertices[edge.second] - a;
  std::vector<std::pair<double, std::uint32_t>> on;
  for (const std::uint32_t v : candidates) {
    const Vec3 from_a = mesh.vertices[v] - a;
    const double t = from_a.dot(way) / way.squaredNorm();
    if (t > 0 && t < 1 && v != edge.first && v != edge.second &&
        (from_a - t * way).norm() <= on_line_mm)
      on.emplace_back(t, v);
  }
  std::sort(on.begin(), on.end());
  std::vector<std::uint32_t> chain = {edge.first};
  for (const auto& [t, v] : on) chain.push_back(v);
  chain.push_back(edge.second);
  return chain;
}

}  // namespace

bool without_border(const TriangleMesh& mesh) {
  Sum sum;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) add(sum, t[k], t[(k + 1) % 3], 1);
  std::erase_if(sum, [](const auto& entry) { return entry.second == 0; });
  constexpr std::size_t most = 4000;  // T-junctions are few; this keeps the search below a second
  if (sum.size() > most) return false;

  std::vector<std::uint32_t> ends;
  for (const auto& [edge, times] : sum) {
    ends.push_back(edge.first);
    ends.push_back(edge.second);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  Sum pieces;
  for (const auto& [edge, times] : sum) {
    const std::vector<std::uint32_t> chain = cut(mesh, edge, ends);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) add(pieces, chain[i], chain[i + 1], times);
  }
  return std::all_of(pieces.begin(), pieces.end(),
                     [](const auto& entry) { return entry.second == 0; });
}

Expected<std::shared_ptr<const TriangleMesh>> setup_solid(const PackageFiles& files,
                                                          const std::string& path,
                                                          const MeshFileOptions& options,
                                                          const SourceSpan& span,
                                                          const std::string& what) {
  auto mesh = files.mesh(path, options);
  if (!mesh) {
    Diagnostic error = mesh.error();
    error.kind = "setup_invalid";
    error.span = span;
    return unexpected(std::move(error));
  }
  if (!without_border(**mesh) || volume(**mesh) <= 0)
    return unexpected(make_error("setup_invalid", span,
                                 "the mesh of the " + what +
                                     " must be closed and face outwards: what is inside of it is "
                                     "not defined otherwise"));
  return mesh;
}

}  // namespace aircut::machine
