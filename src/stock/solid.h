// Initial solids as rays. Private to stock.
#pragma once

#include "stock/brick.h"

namespace aircut::stock {

/// The lattice: nodes at origin + (i + ½) pitch, bricks of 16³ of them.
struct Lattice {
  Vec3 origin = Vec3::Zero();  ///< lowest corner of the initial solid's box
  double pitch = 0;
  std::array<int, 3> bricks{};  ///< per axis

  double brick_size() const { return cells * pitch; }
  double quantum() const { return pitch / quanta_per_cell; }
  std::size_t columns() const { return static_cast<std::size_t>(bricks[0]) * bricks[1]; }
  std::size_t count() const { return columns() * static_cast<std::size_t>(bricks[2]); }
  /// Bricks of a column follow each other from the bottom up.
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(j) * bricks[0] + i) * bricks[2] + k;
  }
};

/// Box of a solid, its parameters checked. Error kinds `stock_shape`, `stock_mesh`.
Expected<Box3> solid_box(const Solid& solid);

/// Whether a closed-form solid fills the cells of a brick, leaves them empty, or neither.
BrickSlot::State classify(const Solid& solid, const Lattice& lattice, int i, int j, int k);

/// The rays of a brick in a closed-form solid.
std::unique_ptr<Brick> fill(const Solid& solid, const Lattice& lattice, int i, int j, int k);

/// All bricks of a closed mesh.
void cast_mesh(const TriangleMesh& mesh, const Lattice& lattice, std::vector<BrickSlot>& table);

/// Puts an interval into a family that has a block. An empty ray takes it, others get an extra one.
void add_interval(RayFamily& family, int ray, const Interval& interval);
/// After filling: the tops, and bits instead of blocks where every ray is full or empty.
void settle(Brick& brick);

}  // namespace aircut::stock
