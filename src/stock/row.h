// Taking one row's chords from a family of rays. Private to stock.
#pragma once

#include "stock/brick.h"

namespace aircut::stock {

/// What a row lost.
struct RowLoss {
  bool changed = false;
  std::int64_t quanta = 0;
};

/// Takes the chords from the row.
RowLoss take_row(RayFamily& family, int row, const Chords& chords, const Kernels& kernels);

/// What taking would lose: the sum, the longest stretch and its middle (ray, quanta).
struct RowTouch {
  std::int64_t quanta = 0;
  int deepest = 0, ray = 0, middle = 0;
};
RowTouch touch_row(const RayFamily& family, int row, const Chords& chords);

}  // namespace aircut::stock
