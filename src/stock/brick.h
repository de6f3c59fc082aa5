// Bricks: the material in 16³ cells, as rays in three directions. Private to stock.
//
// Each family of a brick has 256 rays. X and Y rays lie in rows of equal height (row = k, lane =
// the other coordinate), Z rays in rows of equal j (lane = i). A ray's material is one interval
// [lo, hi) in quanta from the brick's border, and, rarely, more of them in `extra`. A family of
// which every ray is full or empty is kept as one bit per ray.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "stock/kernel.h"
#include "stock/stock.h"

namespace aircut::stock {

inline constexpr int rays = cells * cells;  // of one family in a brick
inline constexpr std::array<Family, 3> families = {Family::x, Family::y, Family::z};
inline int index_of(Family f) { return static_cast<int>(f); }

/// A direction in 16 bits (octahedral, 8 + 8); 0: none, which stands for the direction of the ray.
using NormalCode = std::uint16_t;
NormalCode encode_normal(const Vec3& outward);
Vec3 decode_normal(NormalCode code);

struct Interval {
  std::uint16_t lo = 0, hi = 0;
  NormalCode normal_lo = 0, normal_hi = 0;
};

struct ExtraInterval {
  std::uint16_t ray = 0;
  Interval interval;
};

struct RayBlock {
  alignas(32) std::array<std::uint16_t, rays> lo, hi;
  std::array<NormalCode, rays> normal_lo, normal_hi;
};

struct RayFamily {
  std::unique_ptr<RayBlock> block;          ///< null: every ray is full or empty
  std::array<std::uint16_t, cells> full{};  ///< without a block: bit per ray, a word per row
  std::vector<ExtraInterval> extra;

  void make_block();
  bool row_empty(int row) const;
  bool empty() const;
  /// All intervals of a ray, sorted; normals of ends at the brick's border are left out.
  void intervals(int ray, std::vector<Interval>& out) const;
  std::int64_t quanta() const;
  /// Highest end of any ray of a row, quanta.
  std::uint16_t top(int row) const;
  /// The intervals of a row's rays where they are all there is to it, else null.
  const std::uint16_t* lows(int row) const {
    return block && extra.empty() ? &block->lo[static_cast<std::size_t>(row * cells)] : nullptr;
  }
  const std::uint16_t* highs(int row) const {
    return block && extra.empty() ? &block->hi[static_cast<std::size_t>(row * cells)] : nullptr;
  }
};

struct Brick {
  std::array<RayFamily, 3> family;
  /// No Z ray of a row reaches higher.
  std::array<std::uint16_t, cells> z_tops;
  /// Rows of X and Y rays at and above these are empty.
  std::array<int, 2> rows = {cells, cells};

  Brick() { z_tops.fill(brick_quanta); }
  bool empty() const;
  /// Highest end of any Z ray.
  int z_top() const;
  std::unique_ptr<Brick> clone() const;
  std::size_t bytes() const;
};

/// What stands in the table for 16³ cells.
class BrickSlot {
 public:
  enum State : std::uintptr_t { empty = 0, full = 1, untouched = 2 };

  BrickSlot() = default;
  BrickSlot(BrickSlot&& other) noexcept : word_(other.word_) { other.word_ = empty; }
  BrickSlot& operator=(BrickSlot&& other) noexcept {
    if (this != &other) {
      clear();
      word_ = other.word_;
      other.word_ = empty;
    }
    return *this;
  }
  ~BrickSlot() { clear(); }

  bool is(State state) const { return word_ == state; }
  Brick* brick() const { return word_ > untouched ? reinterpret_cast<Brick*>(word_) : nullptr; }
  void set(State state) {
    clear();
    word_ = state;
  }
  void set(std::unique_ptr<Brick> brick) {
    clear();
    word_ = reinterpret_cast<std::uintptr_t>(brick.release());
  }

 private:
  void clear() {
    if (word_ > untouched) delete reinterpret_cast<Brick*>(word_);
    word_ = empty;
  }
  std::uintptr_t word_ = empty;
};

}  // namespace aircut::stock
