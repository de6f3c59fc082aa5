// Taking one row's chords from a family of rays. Private to stock.
#pragma once

#include "stock/brick.h"

namespace aircut::stock {

/// What a row lost.
struct RowLoss {
  bool changed = false;
  std::int64_t quanta = 0;
};

/// From where to where each ray of a row lost something, quanta from the brick's border; low ≥
/// high: it lost nothing.
struct RowTaken {
  int low[cells], high[cells];
};

/// Takes the chords from the row. `taken`: filled when it lost something; may be null.
RowLoss take_row(RayFamily& family, int row, const Chords& chords, const Kernels& kernels,
                 RowTaken* taken = nullptr);

}  // namespace aircut::stock
