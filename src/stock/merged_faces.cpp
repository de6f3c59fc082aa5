// Two things are put together inside of a brick. Flat squares across an axis become square blocks
// of 2 to 16. What is left becomes strips: rows of squares between two lines parallel to an axis,
// as walls, round or not, and straight edges have them.
//
// A vertex is needed when some face ends there: a corner of a block, an end of a strip, or any
// triangle that stays as it is. The vertices in between are left out by all faces around them, so
// the surface stays closed without cracks: whatever a vertex is between for one face, it is between
// for all. Rims of blocks keep the vertices that others need; then they are fans around a middle.
#include "stock/merged_faces.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace aircut::stock {
namespace {

/// The node `by` steps further along an axis.
std::array<int, 3> step(std::array<int, 3> node, int axis, int by) {
  node[static_cast<std::size_t>(axis)] += by;
  return node;
}

/// A row of squares along an axis, between two lines of vertices.
struct Row {
  std::vector<std::uint32_t> left, right;
};

/// The corners of a square along an axis: low left, low right, high left, high right.
std::array<std::uint32_t, 4> corners_along(const FaceSquare& square, int axis) {
  const auto& c = square.corners;
  if (axis == (square.axis + 2) % 3) return {c[0], c[1], c[3], c[2]};
  return {c[3], c[0], c[2], c[1]};
}

bool near_line(const Vec3& a, const Vec3& b, int axis, double tolerance) {
  const Vec3 d = (a - b).cwiseAbs();
  return d[(axis + 1) % 3] <= tolerance && d[(axis + 2) % 3] <= tolerance;
}

}  // namespace

void MergedFaces::add_block(std::span<const std::uint32_t> rim, std::uint32_t middle,
                            bool forward) {
  faces_.push_back(
      {vertices_.size(), static_cast<std::uint32_t>(rim.size()), middle, true, forward});
  vertices_.insert(vertices_.end(), rim.begin(), rim.end());
}

void MergedFaces::add_strip(std::span<const std::uint32_t> left,
                            std::span<const std::uint32_t> right, bool forward) {
  faces_.push_back({vertices_.size(), static_cast<std::uint32_t>(left.size()), 0, false, forward});
  vertices_.insert(vertices_.end(), left.begin(), left.end());
  vertices_.insert(vertices_.end(), right.begin(), right.end());
}

void MergedFaces::triangulate(TriangleMesh& mesh) const {
  std::vector<bool> needed(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (const auto v : t) needed[v] = true;
  for (const Face& f : faces_) {
    const std::size_t ends = f.block ? f.count / 4 : f.count - 1;
    for (std::size_t i = 0; i < (f.block ? f.count : 2 * f.count); i += f.block ? ends : 1)
      if (f.block || i % f.count == 0 || i % f.count == ends) needed[vertices_[f.first + i]] = true;
  }
  for (const Face& f : faces_) f.block ? block(f, needed, mesh) : strip(f, needed, mesh);

  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), unused);
  for (const auto& t : mesh.triangles)
    for (const auto v : t) number[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == unused) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    number[i] = kept++;
  }
  mesh.vertices.resize(kept);
  for (auto& t : mesh.triangles)
    for (auto& v : t) v = number[v];
}

void MergedFaces::block(const Face& face, const std::vector<bool>& needed,
                        TriangleMesh& mesh) const {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, face.forward ? b : c, face.forward ? c : b});
  };
  std::array<std::uint32_t, 4 * cells> rim{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < face.count; ++i)
    if (needed[vertices_[face.first + i]]) rim[count++] = vertices_[face.first + i];
  if (count == 4) {
    add(rim[0], rim[1], rim[2]);
    add(rim[0], rim[2], rim[3]);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) add(face.middle, rim[i], rim[(i + 1) % count]);
}

void MergedFaces::strip(const Face& face, const std::vector<bool>& needed,
                        TriangleMesh& mesh) const {
  const std::uint32_t* left = &vertices_[face.first];
  const std::uint32_t* right = left + face.count;
  std::size_t l = 0, r = 0;
  const auto next = [&](const std::uint32_t* line, std::size_t i) {
    do {
      ++i;
    } while (i < face.count && !needed[line[i]]);
    return i;
  };
  while (l + 1 < face.count || r + 1 < face.count) {
    const std::size_t up_l = next(left, l), up_r = next(right, r);
    const bool on_right = up_r < up_l || (up_r == up_l && r <= l);
    const std::uint32_t top = on_right ? right[up_r] : left[up_l];
    mesh.triangles.push_back(
        {left[l], face.forward ? right[r] : top, face.forward ? top : right[r]});
    (on_right ? r : l) = on_right ? up_r : up_l;
  }
}

void BrickFaces::add(const FaceSquare& square) {
  squares_.push_back(square);
  index_[place(square.axis, square.node)] = static_cast<std::uint16_t>(squares_.size());
}

/// The square at a place, if it is there and not yet part of something.
const FaceSquare* BrickFaces::free_at(int axis, const std::array<int, 3>& node) const {
  for (const int n : node)
    if (n >= cells) return nullptr;
  const std::size_t i = index_[place(axis, node)];
  return i == 0 || used_[i - 1] ? nullptr : &squares_[i - 1];
}

bool BrickFaces::whole_block(int axis, std::array<int, 3> node, int size) const {
  const FaceSquare* first = free_at(axis, node);
  if (!first || first->plane < 0) return false;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto at = step(step(node, (axis + 1) % 3, x), (axis + 2) % 3, y);
      const FaceSquare* square = free_at(axis, at);
      if (!square || square->plane != first->plane) return false;
    }
  return true;
}

void BrickFaces::blocks(MergedFaces& out) {
  std::vector<std::uint32_t> rim;
  for (int size = cells; size > 1; size /= 2)
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      const FaceSquare& first = squares_[i];
      const int p = (first.axis + 1) % 3, q = (first.axis + 2) % 3;
      if (used_[i] || first.plane < 0 || first.node[static_cast<std::size_t>(p)] % size != 0 ||
          first.node[static_cast<std::size_t>(q)] % size != 0 ||
          !whole_block(first.axis, first.node, size))
        continue;
      const auto square = [&](int x, int y) -> const FaceSquare& {
        return squares_[index_[place(first.axis, step(step(first.node, p, x), q, y))] - 1u];
      };
      rim.clear();
      for (int k = 0; k < size; ++k) rim.push_back(square(k, 0).corners[0]);
      for (int k = 0; k < size; ++k) rim.push_back(square(size - 1, k).corners[1]);
      for (int k = size - 1; k >= 0; --k) rim.push_back(square(k, size - 1).corners[2]);
      for (int k = size - 1; k >= 0; --k) rim.push_back(square(0, k).corners[3]);
      out.add_block(rim, square(size / 2, size / 2).corners[0], first.forward);
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          used_[index_[place(first.axis, step(step(first.node, p, x), q, y))] - 1u] = true;
    }
}

std::vector<FaceSquare> BrickFaces::merge(std::span<const Vec3> vertices,
                                          std::span<const std::uint8_t> straight, double tolerance,
                                          MergedFaces& out) {
  used_.assign(squares_.size(), false);
  blocks(out);

  const auto row_of = [&](const FaceSquare& first, int axis) {
    Row row;
    row.left = {corners_along(first, axis)[0]};
    row.right = {corners_along(first, axis)[1]};
    auto node = first.node;
    for (const FaceSquare* square = &first; square;) {
      const std::uint32_t left = corners_along(*square, axis)[2];
      const std::uint32_t right = corners_along(*square, axis)[3];
      if (!near_line(vertices[left], vertices[row.left[0]], axis, tolerance) ||
          !near_line(vertices[right], vertices[row.right[0]], axis, tolerance))
        break;
      row.left.push_back(left);
      row.right.push_back(right);
      if (!(straight[left] & straight[right] & 1u << axis)) break;
      node = step(node, axis, 1);
      square = free_at(first.axis, node);
    }
    return row;
  };

  std::vector<FaceSquare> alone;
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    if (used_[i]) continue;
    const FaceSquare& first = squares_[i];
    int axis = (first.axis + 1) % 3;
    Row row = row_of(first, axis);
    if (Row other = row_of(first, (first.axis + 2) % 3); other.left.size() > row.left.size()) {
      axis = (first.axis + 2) % 3;
      row = std::move(other);
    }
    const int count = static_cast<int>(row.left.size()) - 1;
    if (count < 2) {
      alone.push_back(first);
      continue;
    }
    out.add_strip(row.left, row.right, first.forward);
    for (int k = 0; k < count; ++k)
      used_[index_[place(first.axis, step(first.node, axis, k))] - 1u] = true;
  }
  for (const FaceSquare& s : squares_) index_[place(s.axis, s.node)] = 0;
  squares_.clear();
  return alone;
}

}  // namespace aircut::stock
