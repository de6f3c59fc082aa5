// Cutting: which bricks a piece concerns, and in which order.
//
// Pieces are taken in batches. A batch is binned to the columns of bricks under its pieces; a
// column is one thread's. In each column, first the Z rays in program order, so that what a Z ray
// loses is credited to the move that takes it first; then the X and Y rays, the deepest pieces
// first, because then most of the others find nothing left. A brick is skipped when a bound proves
// that none of this family's rays can change, and emptied at once when a bound proves that all of
// it is taken. Both bounds keep more margin than the kernels' rounding and look at one family only:
// so the material that is left doesn't depend on order, batch or threads.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <thread>
#include <unordered_map>

#include "stock/impl.h"
#include "stock/row.h"

namespace aircut::stock {
namespace {

/// Sums of one thread: what each slot lost on Z rays.
struct Sums {
  std::vector<std::int64_t> quanta;
  std::vector<SliceExtent> slices;
  std::ptrdiff_t bytes = 0;
};

class ColumnCutter {
 public:
  ColumnCutter(Stock::Impl& stock, int i, int j, Sums& sums)
      : stock_(stock), i_(i), j_(j), sums_(sums), top_(stock.tops[column()]) {}

  void cut(const std::vector<const Sweep*>& sweeps) {
    std::vector<Work> work;
    for (const Sweep* sweep : sweeps) {
      ColumnSweep column = ColumnSweep::of(*sweep, lattice(), i_, j_);
      if (column.touches()) work.push_back({column, sweep->slot, sweep->watch});
    }
    for (const Work& w : work) cut_z(w);
    std::stable_sort(work.begin(), work.end(), [](const Work& a, const Work& b) {
      return depth_key(a.sweep) < depth_key(b.sweep);
    });
    for (const Work& w : work) cut_sides(w);
  }

 private:
  /// Sorts what takes most to the front.
  static std::pair<bool, double> depth_key(const ColumnSweep& sweep) {
    if (sweep.tilted) return {true, sweep.tilted->lowest_tip()};
    return {!sweep.covers, sweep.covers ? sweep.cover_floor : sweep.nearest};
  }

  struct Work {
    ColumnSweep sweep;
    std::size_t slot;
    const SliceWatch* watch;
  };

  const Lattice& lattice() const { return stock_.lattice; }
  std::size_t column() const { return static_cast<std::size_t>(j_) * lattice().bricks[0] + i_; }
  BrickSlot& slot(int k) { return stock_.table[lattice().index(i_, j_, k)]; }

  /// Calls f(k, bottom) from the top down for the bricks that the sweep may reach.
  template <class F>
  void each_brick(const ColumnSweep& sweep, F f) {
    const double size = lattice().brick_size();
    while (top_ > 0 && slot(top_ - 1).is(BrickSlot::empty)) --top_;
    for (int k = top_ - 1; k >= 0; --k) {
      const double bottom = k * size;
      if (bottom + size < sweep.floor) break;
      if (bottom > sweep.roof || slot(k).is(BrickSlot::empty)) continue;
      f(k, bottom);
    }
  }

  /// The brick to be cut; one that was full is put into the table only when it changed.
  Brick& take_out(int k) {
    BrickSlot& s = slot(k);
    if (s.is(BrickSlot::untouched)) {
      s.set(fill(stock_.solid, lattice(), i_, j_, k));
      sums_.bytes += static_cast<std::ptrdiff_t>(s.brick()->bytes());
    }
    if (Brick* brick = s.brick()) return *brick;
    if (!fresh_) {
      fresh_ = std::make_unique<Brick>();
      for (RayFamily& family : fresh_->family) family.full.fill(0xffff);
    }
    return *fresh_;
  }

  void put_back(int k, bool changed, std::size_t bytes_before) {
    if (!changed) return;
    BrickSlot& s = slot(k);
    if (!s.brick()) {
      s.set(std::move(fresh_));
      bytes_before = 0;
    }
    sums_.bytes += static_cast<std::ptrdiff_t>(s.brick()->bytes() - bytes_before);
    const Brick& brick = *s.brick();
    if (brick.rows[0] == 0 && brick.rows[1] == 0 && brick.z_top() == 0) drop(k);
  }

  void drop(int k) {
    if (const Brick* brick = slot(k).brick())
      sums_.bytes -= static_cast<std::ptrdiff_t>(brick->bytes());
    slot(k).set(BrickSlot::empty);
  }

  void take_whole(int k, const Work& work) {
    std::int64_t quanta = std::int64_t{rays} * brick_quanta;
    if (!slot(k).is(BrickSlot::full)) quanta = take_out(k).family[2].quanta();
    sums_.quanta[work.slot] += quanta;
    if (work.watch && quanta > 0) {
      // Every ray of it, from border to border: chords that go over both.
      Chords all{};
      std::fill_n(all.b, cells, brick_quanta);
      Brick& brick = take_out(k);
      const std::size_t before = brick.bytes();
      for (int row = 0; row < cells; ++row) {
        RowTaken taken;
        if (take_row(brick.family[2], row, all, kernels_, &taken).quanta > 0)
          see(*work.watch, k, row, taken);
      }
      if (slot(k).brick())
        sums_.bytes +=
            static_cast<std::ptrdiff_t>(brick.bytes()) - static_cast<std::ptrdiff_t>(before);
      else
        fresh_.reset();
    }
    drop(k);
  }

  void see(const SliceWatch& watch, int k, int row, const RowTaken& taken) {
    const double pitch = lattice().pitch, quantum = lattice().quantum();
    const double bottom = k * lattice().brick_size(), y = (j_ * cells + row + 0.5) * pitch;
    for (int lane = 0; lane < cells; ++lane)
      if (const int from = taken.low[lane], to = taken.high[lane]; from < to)
        watch.see((i_ * cells + lane + 0.5) * pitch, y, bottom + from * quantum,
                  bottom + to * quantum, to - from, sums_.slices.data());
  }

  void cut_z(const Work& work) {
    const ColumnSweep& sweep = work.sweep;
    const double size = lattice().brick_size();
    each_brick(sweep, [&](int k, double bottom) {
      if (sweep.tilted ? sweep.tilted->takes_all(brick_box(k))
                       : sweep.takes_all(bottom, bottom + size))
        return take_whole(k, work);
      Brick& brick = take_out(k);
      const double quanta = (sweep.floor - bottom) / lattice().quantum() - 1;
      if (quanta > brick.z_top()) return;
      if (sweep.tilted && sweep.tilted->misses(brick_box(k))) return;
      const std::size_t bytes = brick.bytes();
      RayFamily& family = brick.family[2];
      const LocalSweep local = sweep.in_brick(lattice(), k);
      bool changed = false;
      for (int row = sweep.first_row; row < sweep.end_row; ++row) {
        std::uint16_t& top = brick.z_tops[static_cast<std::size_t>(row)];
        if (top == 0 || quanta > top) continue;
        if (sweep.tilted) {
          if (sweep.tilted->misses(row_box(k, Family::z, row, family))) continue;
          if (!sweep.tilted->chords(lattice(), {i_, j_, k}, Family::z, row, family.lows(row),
                                    family.highs(row), chords_))
            continue;
        } else if (!kernels_.upright(local, row, family.lows(row), family.highs(row), chords_)) {
          continue;
        }
        RowTaken taken;
        const RowLoss loss =
            take_row(family, row, chords_, kernels_, work.watch ? &taken : nullptr);
        sums_.quanta[work.slot] += loss.quanta;
        if (work.watch && loss.quanta > 0) see(*work.watch, k, row, taken);
        if (!loss.changed) continue;
        changed = true;
        top = family.top(row);
      }
      put_back(k, changed, bytes);
    });
  }

  void cut_sides(const Work& work) {
    each_brick(work.sweep, [&](int k, double) {
      if (work.sweep.tilted && work.sweep.tilted->misses(brick_box(k))) return;
      Brick& brick = take_out(k);
      const std::size_t bytes = brick.bytes();
      const LocalSweep local = work.sweep.in_brick(lattice(), k);
      bool changed = false;
      for (const Family f : {Family::x, Family::y})
        changed = cut_family(brick, k, f, work.sweep, local) || changed;
      put_back(k, changed, bytes);
    });
  }

  Box3 brick_box(int k) const {
    const Vec3 low = lattice().brick_size() * Vec3(i_, j_, k);
    return {low, low + Vec3::Constant(lattice().brick_size())};
  }

  /// The box of what is left on a row's rays.
  Box3 row_box(int k, Family f, int row, const RayFamily& family) const {
    Box3 out = brick_box(k);
    const Vec3 low = out.min();
    const int axis = f == Family::z ? 1 : 2;
    out.min()[axis] = out.max()[axis] = low[axis] + (row + 0.5) * lattice().pitch;
    const std::uint16_t *lo = family.lows(row), *hi = family.highs(row);
    if (!lo) return out;
    int first = cells, last = -1, from = brick_quanta, to = 0;
    for (int lane = 0; lane < cells; ++lane) {
      if (lo[lane] >= hi[lane]) continue;
      first = std::min(first, lane);
      last = lane;
      from = std::min<int>(from, lo[lane]);
      to = std::max<int>(to, hi[lane]);
    }
    const int along = index_of(f), lanes = f == Family::x ? 1 : 0;
    out.min()[lanes] = low[lanes] + (first + 0.5) * lattice().pitch;
    out.max()[lanes] = low[lanes] + (last + 0.5) * lattice().pitch;
    out.min()[along] = low[along] + from * lattice().quantum();
    out.max()[along] = low[along] + to * lattice().quantum();
    return out;
  }

  bool cut_family(Brick& brick, int k, Family f, const ColumnSweep& sweep,
                  const LocalSweep& local) {
    const double bottom = k * lattice().brick_size();
    RayFamily& family = brick.family[static_cast<std::size_t>(index_of(f))];
    int& rows = brick.rows[static_cast<std::size_t>(index_of(f))];
    bool changed = false, walls_known = false;
    for (int row = 0; row < rows; ++row) {
      const double z = bottom + (row + 0.5) * lattice().pitch;
      if (z < sweep.floor) continue;
      if (z > sweep.roof) break;
      if (family.row_empty(row)) continue;
      if (sweep.tilted) {
        if (sweep.tilted->misses(row_box(k, f, row, family))) continue;
        if (sweep.tilted->chords(lattice(), {i_, j_, k}, f, row, family.lows(row),
                                 family.highs(row), chords_))
          changed = take_row(family, row, chords_, kernels_).changed || changed;
        continue;
      }
      // All rows that see only the straight wall have the same chords.
      const bool wall = sees_only_wall(local, row);
      if (wall && !walls_known) kernels_.level(local, f, row, nullptr, nullptr, walls_);
      walls_known = walls_known || wall;
      if (!wall && !kernels_.level(local, f, row, family.lows(row), family.highs(row), chords_))
        continue;
      const Chords& chords = wall ? walls_ : chords_;
      changed = take_row(family, row, chords, kernels_).changed || changed;
    }
    if (changed)
      while (rows > 0 && family.row_empty(rows - 1)) --rows;
    return changed;
  }

  bool sees_only_wall(const LocalSweep& local, int row) const {
    const double z = (row + 0.5) * local.pitch - local.foot[2];
    const double za = z - local.slope * local.s0, zb = z - local.slope * local.s1;
    return std::min(za, zb) - local.rise >= local.shape->wall_low &&
           std::max(za, zb) <= local.shape->wall_high;
  }

  Stock::Impl& stock_;
  int i_, j_;
  Sums& sums_;
  int& top_;
  const Kernels& kernels_ = kernels();
  std::unique_ptr<Brick> fresh_;
  Chords chords_, walls_;
};

/// The columns under a batch of sweeps, each with its sweeps in order.
struct Bins {
  std::vector<std::size_t> columns;
  std::unordered_map<std::size_t, std::vector<const Sweep*>> sweeps;
};

Bins bin(std::span<const Sweep> sweeps, const Lattice& lattice) {
  Bins out;
  for (const Sweep& sweep : sweeps)
    each_column(sweep, lattice, [&](int i, int j) {
      const std::size_t column = static_cast<std::size_t>(j) * lattice.bricks[0] + i;
      auto& list = out.sweeps[column];
      if (list.empty()) out.columns.push_back(column);
      list.push_back(&sweep);
    });
  std::sort(out.columns.begin(), out.columns.end());
  return out;
}

void cut_batch(Stock::Impl& stock, std::span<const Sweep> sweeps, std::vector<Removal>& rows,
               std::vector<SliceExtent>& slices) {
  const Bins bins = bin(sweeps, stock.lattice);
  const unsigned threads = std::max(stock.options.threads, 1u);
  std::vector<Sums> sums(threads);
  for (Sums& s : sums) {
    s.quanta.assign(rows.size(), 0);
    s.slices.assign(slices.size(), {});
  }
  for_each_index(bins.columns.size(), threads, [&](std::size_t n, unsigned thread) {
    const std::size_t column = bins.columns[n], width = stock.lattice.bricks[0];
    ColumnCutter(stock, static_cast<int>(column % width), static_cast<int>(column / width),
                 sums[thread])
        .cut(bins.sweeps.at(column));
  });
  for (const Sums& s : sums) {
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].quanta += s.quanta[i];
    for (std::size_t i = 0; i < slices.size(); ++i) slices[i].add(s.slices[i]);
    stock.brick_bytes += static_cast<std::size_t>(s.bytes);
  }
}

}  // namespace

Expected<void> supported(std::span<const Piece> pieces) {
  for (const Piece& piece : pieces) {
    if (!piece.start.allFinite() || !piece.end.allFinite())
      return unexpected(make_error("stock_unsupported", "a cutter's position is not a number"));
    if (!(std::abs(piece.axis.norm() - 1) < 1e-6))
      return unexpected(make_error("stock_unsupported", "a tool axis is not a unit vector"));
  }
  return {};
}

void for_each_index(std::size_t n, unsigned threads,
                    const std::function<void(std::size_t, unsigned)>& f) {
  if (threads <= 1 || n <= 1) {
    for (std::size_t i = 0; i < n; ++i) f(i, 0);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;
  for (unsigned t = 0; t < threads; ++t)
    workers.emplace_back([&, t] {
      for (std::size_t i = next++; i < n; i = next++) f(i, t);
    });
  for (std::thread& worker : workers) worker.join();
}

namespace {

// The slices of a batch that took something, as fractions of their pieces' ways.
void add_slices(const std::vector<SliceWatch>& watches, const std::vector<SliceExtent>& extents,
                double ray_volume, std::vector<Slice>& out) {
  for (const SliceWatch& watch : watches)
    for (std::size_t i = 0; i < watch.count; ++i) {
      const SliceExtent& e = extents[watch.first + i];
      if (e.quanta == 0) continue;
      const auto count = static_cast<double>(watch.count), at = static_cast<double>(i);
      Slice slice{watch.piece, at / count, (at + 1) / count, {}};
      slice.in.volume = static_cast<double>(e.quanta) * ray_volume;
      if (e.high >= e.low) slice.in.depth = e.high - e.low;
      if (watch.length > 0) slice.in.left = e.left;
      if (watch.length > 0) slice.in.right = e.right;
      out.push_back(slice);
    }
}

}  // namespace

Expected<std::vector<Removal>> Stock::cut(std::span<const Piece> pieces) {
  std::vector<Slice> none;
  return cut(pieces, 0, none);
}

Expected<std::vector<Removal>> Stock::cut(std::span<const Piece> pieces, double length,
                                          std::vector<Slice>& slices) {
  if (auto ok = supported(pieces); !ok) return unexpected(ok.error());
  std::vector<Removal> out, rows;
  std::vector<SliceWatch> watches;
  std::vector<SliceExtent> extents;
  std::size_t done = 0;
  std::unordered_map<std::uint32_t, std::size_t> out_of, row_of;
  std::vector<Sweep> sweeps;
  const std::size_t batch = std::max<std::size_t>(impl_->options.batch, 1);
  while (!pieces.empty()) {
    const auto part = pieces.first(std::min(batch, pieces.size()));
    pieces = pieces.subspan(part.size());
    sweeps.clear();
    rows.clear();
    row_of.clear();
    watches.clear();
    if (length > 0) watches.reserve(part.size());  // sweeps point at them
    std::size_t watched = 0;
    for (const Piece& piece : part) {
      const auto [row, fresh] = row_of.try_emplace(piece.move, rows.size());
      if (fresh) rows.push_back({.move = piece.move});
      if (length > 0) {
        SliceWatch& watch =
            watches.emplace_back(SliceWatch::of(piece, impl_->lattice.origin, length));
        watch.piece = done++;
        watch.first = watched;
        watched += watch.count;
      }
      for (const Outline& body : piece.cutter->bodies()) {
        sweeps.push_back(Sweep::of(body, piece, impl_->lattice, row->second));
        if (length > 0) sweeps.back().watch = &watches.back();
      }
    }
    extents.assign(watched, {});
    cut_batch(*impl_, sweeps, rows, extents);
    const double ray_volume = impl_->lattice.quantum() * pitch() * pitch();
    add_slices(watches, extents, ray_volume, slices);
    for (const Removal& row : rows) {  // a move may go on over the end of a batch
      const auto [at, fresh] = out_of.try_emplace(row.move, out.size());
      if (fresh) out.push_back({.move = row.move});
      out[at->second].quanta += row.quanta;
    }
    if (bytes() > impl_->options.memory_limit) return unexpected(too_large(*impl_));
  }
  for (Removal& row : out) row.volume = volume_of(row.quanta);
  return out;
}

}  // namespace aircut::stock
