// The stock's state. Private to stock.
#pragma once

#include <functional>

#include "stock/solid.h"
#include "stock/sweep.h"

namespace aircut::stock {

inline constexpr double finest_pitch = 1e-4;       // mm
inline constexpr double largest_coordinate = 1e6;  // mm: a kilometre, beyond which a unit is wrong

struct Stock::Impl {
  Solid solid;
  Box3 box;
  Lattice lattice;
  StockOptions options;
  std::vector<BrickSlot> table;
  std::vector<int> tops;  ///< per column: one above its highest brick that may hold material
  std::size_t brick_bytes = 0;

  /// The brick at a place, filled from the initial solid when nobody was there before; null when it
  /// is full or empty. `scratch` holds what is not in the table.
  const Brick* look(int i, int j, int k, std::unique_ptr<Brick>& scratch) const;
};

/// The error `stock_memory` of a stock that outgrew its limit while it was cut.
Diagnostic too_large(const Stock::Impl& stock);

/// A motion that the kernels don't model, or nothing.
Expected<void> supported(std::span<const Piece> pieces);

/// Runs f(0) … f(n − 1) on some threads; each index once.
void for_each_index(std::size_t n, unsigned threads,
                    const std::function<void(std::size_t index, unsigned thread)>& f);

}  // namespace aircut::stock
