// A lattice's surface in few triangles: the squares of one brick, put together. Private to stock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/geometry.h"
#include "stock/kernel.h"

namespace aircut::stock {

/// A polygon of four cells around an edge of the lattice.
struct FaceSquare {
  int axis = 0;               ///< of the edge; p and q are the two that follow in turn
  std::array<int, 3> node{};  ///< where the edge begins, 0 … 15 in its brick
  bool forward = true;        ///< faces the axis' end
  std::int32_t plane = -1;    ///< ≥ 0: flat at this height, and so are all squares around
  /// The vertices at (p, q) = (0, 0), (1, 0), (1, 1), (0, 1).
  std::array<std::uint32_t, 4> corners{};
};

/// What is put together, of all bricks, until every brick has said where it needs a vertex.
class MergedFaces {
 public:
  /// A flat square block: its rim in turn, counter-clockwise if `forward`, four of it corners of
  /// the block (each `size`-th); and a vertex inside.
  void add_block(std::span<const std::uint32_t> rim, std::uint32_t middle, bool forward);
  /// A strip between two parallel lines; upwards, `left` to `right` is counter-clockwise if
  /// `forward`.
  void add_strip(std::span<const std::uint32_t> left, std::span<const std::uint32_t> right,
                 bool forward);
  /// Adds their triangles to those that are there, and leaves out the vertices that none has.
  void triangulate(TriangleMesh& mesh) const;

 private:
  struct Face {
    std::size_t first = 0;  ///< in vertices_: the rim; or left, then right
    std::uint32_t count = 0;
    std::uint32_t middle = 0;  ///< of a block
    bool block = false, forward = true;
  };
  void block(const Face& face, const std::vector<bool>& needed, TriangleMesh& mesh) const;
  void strip(const Face& face, const std::vector<bool>& needed, TriangleMesh& mesh) const;

  std::vector<Face> faces_;
  std::vector<std::uint32_t> vertices_;
};

/// The squares of one brick.
class BrickFaces {
 public:
  void add(const FaceSquare& square);

  /// Puts together what is flat or straight; what stays alone comes back, and the brick is empty
  /// again. `straight` has for each vertex a bit per axis along which the surface goes on straight
  /// through its cell; places differ by at most `tolerance`, mm.
  std::vector<FaceSquare> merge(std::span<const Vec3> vertices,
                                std::span<const std::uint8_t> straight, double tolerance,
                                MergedFaces& out);

 private:
  static std::size_t place(int axis, const std::array<int, 3>& node) {
    return static_cast<std::size_t>(((axis * cells + node[2]) * cells + node[1]) * cells + node[0]);
  }
  const FaceSquare* free_at(int axis, const std::array<int, 3>& node) const;
  bool whole_block(int axis, std::array<int, 3> node, int size) const;
  void blocks(MergedFaces& out);

  std::vector<FaceSquare> squares_;
  std::vector<bool> used_;
  /// Which of squares_ is at a place, counted from 1.
  std::vector<std::uint16_t> index_ = std::vector<std::uint16_t>(3 * cells * cells * cells);
};

}  // namespace aircut::stock
