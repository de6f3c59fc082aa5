#include "page/pack.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace aircut::page {

Row Blob::add(const std::vector<std::int64_t>& values) {
  const Row row{bytes_.size(), values.size()};
  std::int64_t before = 0;
  for (const std::int64_t value : values) {
    const std::int64_t step = value - before;
    before = value;
    std::uint64_t rest =
        (static_cast<std::uint64_t>(step) << 1) ^ static_cast<std::uint64_t>(step < 0 ? -1 : 0);
    for (; rest >= 0x80; rest >>= 7) bytes_ += static_cast<char>((rest & 0x7f) | 0x80);
    bytes_ += static_cast<char>(rest);
  }
  return row;
}

Row Blob::add_text(std::string_view text) {
  const Row row{bytes_.size(), text.size()};
  bytes_ += text;
  return row;
}

TriangleMesh clustered(const TriangleMesh& mesh, double cell) {
  struct Cell {
    Mat3 squares = Mat3::Zero();  ///< Σ area · n nᵀ
    Vec3 right = Vec3::Zero();    ///< Σ area · n (n · p)
    Vec3 sum = Vec3::Zero();
    double count = 0;
  };
  const Box3 box = bounds(mesh);
  std::map<std::tuple<int, int, int>, std::uint32_t> known;
  std::vector<Cell> cells;
  std::vector<std::uint32_t> cell_of(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 at = (mesh.vertices[i] - box.min()) / cell;
    const std::tuple key(static_cast<int>(at.x()), static_cast<int>(at.y()),
                         static_cast<int>(at.z()));
    const auto [found, is_new] = known.emplace(key, static_cast<std::uint32_t>(cells.size()));
    if (is_new) cells.emplace_back();
    cell_of[i] = found->second;
    cells[found->second].sum += mesh.vertices[i];
    cells[found->second].count += 1;
  }
  TriangleMesh out;
  for (const auto& triangle : mesh.triangles) {
    const Vec3& a = mesh.vertices[triangle[0]];
    const Vec3 twice = (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
    const double area = twice.norm();
    if (!(area > 0)) continue;
    const Vec3 n = twice / area;
    std::array<std::uint32_t, 3> to{};
    for (std::size_t k = 0; k < 3; ++k) {
      to[k] = cell_of[triangle[k]];
      cells[to[k]].squares += area * n * n.transpose();
      cells[to[k]].right += area * n * n.dot(mesh.vertices[triangle[k]]);
    }
    if (to[0] != to[1] && to[1] != to[2] && to[2] != to[0]) out.triangles.push_back(to);
  }
  for (const Cell& c : cells) {
    const Vec3 middle = c.sum / c.count;
    // Along directions that no plane holds, the point stays at the middle.
    const double weak = 1e-3 * c.squares.trace() + 1e-300;
    const Mat3 lifted = c.squares + weak * Mat3::Identity();
    Vec3 best = middle + lifted.ldlt().solve(c.right - c.squares * middle);
    if (!best.allFinite() || (best - middle).norm() > cell) best = middle;
    out.vertices.push_back(best);
  }
  return out;
}

TriangleMesh at_most(const TriangleMesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return mesh;
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                .norm() /
            2;
  // A surface of that area has about two triangles per cell that it goes through.
  double cell = std::sqrt(2 * area / static_cast<double>(most));
  while (true) {
    TriangleMesh out = clustered(mesh, cell);
    if (out.triangles.size() <= most) return out;
    cell *= 1.25;
  }
}

}  // namespace aircut::page
