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

}  // namespace aircut::stock
