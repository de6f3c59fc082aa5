#include "stock/row.h"

#include <algorithm>
#include <bit>

namespace aircut::stock {
namespace {

/// The smaller of two normals of ends at the same place, so that the order of cuts doesn't matter.
NormalCode either(NormalCode a, NormalCode b) { return a == 0 ? b : std::min(a, b); }

NormalCode code(std::int32_t normal) { return static_cast<NormalCode>(normal); }

template <class F>
void each_lane(std::uint32_t bits, F f) {
  for (; bits != 0; bits &= bits - 1) f(std::countr_zero(bits));
}

void widen(RowTaken& taken, int lane, int from, int to) {
  taken.low[lane] = std::min(taken.low[lane], from);
  taken.high[lane] = std::max(taken.high[lane], to);
}

/// The same as the kernel's `take` for the intervals beyond a ray's first.
void take_extra(RayFamily& family, int row, const Chords& chords, RowLoss& loss, RowTaken* taken) {
  std::vector<ExtraInterval> left;
  bool changed = false;
  for (const ExtraInterval& e : family.extra) {
    const int lane = e.ray % cells, a = chords.a[lane], b = chords.b[lane];
    Interval i = e.interval;
    if (e.ray / cells != row || a >= b || a > i.hi || b < i.lo) {
      left.push_back(e);
      continue;
    }
    changed = true;
    if (a == i.hi || b == i.lo) {
      if (a == i.hi) i.normal_hi = either(i.normal_hi, code(chords.normal_a[lane]));
      if (b == i.lo) i.normal_lo = either(i.normal_lo, code(chords.normal_b[lane]));
      left.push_back({e.ray, i});
      continue;
    }
    const int from = std::max<int>(a, i.lo), to = std::min<int>(b, i.hi);
    loss.quanta += to - from;
    if (taken) widen(*taken, lane, from, to);
    if (a > i.lo)
      left.push_back(
          {e.ray, {i.lo, static_cast<std::uint16_t>(a), i.normal_lo, code(chords.normal_a[lane])}});
    if (b < i.hi)
      left.push_back(
          {e.ray, {static_cast<std::uint16_t>(b), i.hi, code(chords.normal_b[lane]), i.normal_hi}});
  }
  if (!changed) return;
  loss.changed = true;
  family.extra = std::move(left);
}

}  // namespace

RowLoss take_row(RayFamily& family, int row, const Chords& chords, const Kernels& kernels,
                 RowTaken* taken) {
  RowLoss loss;
  if (taken) {
    std::fill_n(taken->low, cells, brick_quanta);
    std::fill_n(taken->high, cells, 0);
  }
  if (!family.extra.empty()) take_extra(family, row, chords, loss, taken);

  const auto first = static_cast<std::size_t>(row * cells);
  std::uint16_t lo[cells], hi[cells], old_lo[cells], old_hi[cells];
  if (family.block) {
    std::copy_n(&family.block->lo[first], cells, lo);
    std::copy_n(&family.block->hi[first], cells, hi);
  } else {
    const std::uint16_t full = family.full[static_cast<std::size_t>(row)];
    for (int i = 0; i < cells; ++i) {
      lo[i] = 0;
      hi[i] = full >> i & 1 ? brick_quanta : 0;
    }
  }
  std::copy_n(lo, cells, old_lo);
  std::copy_n(hi, cells, old_hi);
  RowChange change;
  kernels.take(lo, hi, chords, change);
  if (!change.any()) return loss;
  loss.quanta += change.lost;
  if (taken && change.lost > 0)
    for (int i = 0; i < cells; ++i) {
      const int from = std::max<int>(chords.a[i], old_lo[i]);
      const int to = std::min<int>(chords.b[i], old_hi[i]);
      if (from < to) widen(*taken, i, from, to);
    }
  loss.changed = loss.changed || (change.low | change.high) != 0;

  if (!family.block) {
    if ((change.low | change.high) == 0) return loss;  // touched at the brick's border only
    // Still all full or empty: lanes that moved at both ends are empty now.
    const std::uint32_t moved = change.low | change.high;
    if ((change.low & change.high) == moved && change.split == 0) {
      family.full[static_cast<std::size_t>(row)] =
          static_cast<std::uint16_t>(family.full[static_cast<std::size_t>(row)] & ~moved);
      return loss;
    }
    family.make_block();
  }
  RayBlock& block = *family.block;
  each_lane(change.split, [&](int lane) {
    const auto i = first + static_cast<std::size_t>(lane);
    family.extra.push_back({static_cast<std::uint16_t>(i),
                            {static_cast<std::uint16_t>(chords.b[lane]), old_hi[lane],
                             code(chords.normal_b[lane]), block.normal_hi[i]}});
  });
  std::copy_n(lo, cells, &block.lo[first]);
  std::copy_n(hi, cells, &block.hi[first]);
  const std::uint32_t emptied = change.low & change.high;
  const auto at = [&](int lane) { return first + static_cast<std::size_t>(lane); };
  each_lane(emptied, [&](int lane) { block.normal_lo[at(lane)] = block.normal_hi[at(lane)] = 0; });
  each_lane(change.low & ~emptied,
            [&](int lane) { block.normal_lo[at(lane)] = code(chords.normal_b[lane]); });
  each_lane(change.high & ~emptied,
            [&](int lane) { block.normal_hi[at(lane)] = code(chords.normal_a[lane]); });
  each_lane(change.same_low, [&](int lane) {
    block.normal_lo[at(lane)] = either(block.normal_lo[at(lane)], code(chords.normal_b[lane]));
  });
  each_lane(change.same_high, [&](int lane) {
    block.normal_hi[at(lane)] = either(block.normal_hi[at(lane)], code(chords.normal_a[lane]));
  });
  return loss;
}

}  // namespace aircut::stock
