// Welding and shells of triangle meshes.
//
// Welding puts every position into an open-addressing hash table; the first vertex with a position
// keeps its place in the order, so the result depends on the input's order and on nothing else. The
// hash decides only where to look, never what comes first.
//
// Shells come from sorting all edges (low vertex, high vertex): the triangles of one run of equal
// edges belong together (union-find over triangles). A shell is closed when each of its edges has
// exactly two triangles that run along it in opposite directions.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "geometry/mesh.h"

namespace aircut {
namespace {

std::uint64_t mixed(std::uint64_t h) {
  h ^= h >> 31;
  h *= 0x9e3779b97f4a7c15u;
  h ^= h >> 29;
  return h;
}

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t h = 0;
  for (int i = 0; i < 3; ++i)
    h = mixed(h + std::bit_cast<std::uint64_t>(p[i]) * 0xd6e8feb86659fd93u);
  return h;
}

/// Numbers positions in the order of their first appearance.
class PositionIndex {
 public:
  explicit PositionIndex(std::size_t expected)
      : slots_(std::bit_ceil(2 * expected + 16), empty_slot), mask_(slots_.size() - 1) {}

  std::uint32_t add(const Vec3& position, std::vector<Vec3>& out) {
    const Vec3 p = position + Vec3::Zero();  // -0 becomes 0, so that equal means the same bits
    for (std::size_t i = hash_of(p) & mask_;; i = (i + 1) & mask_) {
      if (slots_[i] == empty_slot) {
        slots_[i] = static_cast<std::uint32_t>(out.size());
        out.push_back(p);
        return slots_[i];
      }
      if (out[slots_[i]] == p) return slots_[i];
    }
  }

 private:
  static constexpr std::uint32_t empty_slot = 0xffffffffu;
  std::vector<std::uint32_t> slots_;
  std::size_t mask_;
};

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a).squaredNorm() > 0;
}

struct Edge {
  std::uint32_t low, high, triangle;
  bool forward;  ///< the triangle runs from low to high

  bool same_line(const Edge& other) const { return low == other.low && high == other.high; }
  bool operator<(const Edge& other) const {
    return std::tie(low, high, triangle, forward) <
           std::tie(other.low, other.high, other.triangle, other.forward);
  }
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), i, from < to});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Sets of triangles; the representative of a set is its lowest triangle.
class TriangleSets {
 public:
  explicit TriangleSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

TriangleMesh welded(const TriangleMesh& mesh) {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  PositionIndex index(std::min(mesh.vertices.size(), 3 * mesh.triangles.size()));
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0xffffffffu);
  for (const auto& t : mesh.triangles) {
    // Vertices of dropped triangles must not stay behind, so look before adding.
    if (!has_area(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& n = number[t[k]];
      if (n == 0xffffffffu) n = index.add(mesh.vertices[t[k]], positions);
      corner[k] = n;
    }
    triangles.push_back(corner);
  }
  return {std::move(positions), std::move(triangles)};
}

std::vector<Shell> shells(const TriangleMesh& mesh) {
  const std::vector<Edge> edges = sorted_edges(mesh);
  TriangleSets sets(mesh.triangles.size());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].same_line(edges[i - 1])) sets.join(edges[i].triangle, edges[i - 1].triangle);

  std::vector<Shell> out;
  std::vector<std::uint32_t> shell_of(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t root = sets.find(i);
    if (root == i) {
      shell_of[i] = static_cast<std::uint32_t>(out.size());
      out.push_back({.triangles = {}, .closed = true});
    }
    shell_of[i] = shell_of[root];
    out[shell_of[i]].triangles.push_back(i);
  }
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].same_line(edges[i])) ++end;
    const bool paired = end - i == 2 && edges[i].forward != edges[i + 1].forward;
    if (!paired) out[shell_of[edges[i].triangle]].closed = false;
  }
  return out;
}

}  // namespace aircut
