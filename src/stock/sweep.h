// One convex body on a straight path, as the columns of bricks see it. Private to stock.
#pragma once

#include <algorithm>
#include <cmath>

#include "stock/outline.h"
#include "stock/slices.h"
#include "stock/solid.h"
#include "stock/tilted.h"

namespace aircut::stock {

inline constexpr double sweep_margin = 1e-5;  // mm, more than the kernels' rounding

/// A body of a piece's cutter with its path, in the lattice's frame (origin at its lowest corner).
struct Sweep {
  const Outline* outline = nullptr;
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< in plan, unit
  double length = 0;                                     ///< in plan; 0: a plunge
  double slope = 0;
  double tip_low = 0, tip_high = 0;
  std::shared_ptr<const TiltedSweep> tilted;  ///< null: the axis is Z
  std::size_t slot = 0;                       ///< whom the removed length is credited to
  const SliceWatch* watch = nullptr;          ///< of its piece; null: nobody wants to know

  static Sweep of(const Outline& outline, const Piece& piece, const Lattice& lattice,
                  std::size_t slot);
};

/// A sweep over one column of bricks: bounds that decide which bricks need their rays looked at,
/// and the frame of the kernels. Heights are of the lattice.
struct ColumnSweep {
  const TiltedSweep* tilted = nullptr;
  double nearest = 0;      ///< from the column's square to the path, in plan
  double floor = 0;        ///< nothing below this is touched
  double roof = 0;         ///< nothing above this
  bool covers = false;     ///< every point of the square is under the cutter at some time, …
  double cover_floor = 0;  ///< … and all between these heights is taken
  double cover_roof = 0;
  int first_row = 0, end_row = cells;  ///< of Z rays, that the cutter may reach
  LocalSweep local{};                  ///< of the column's lowest brick

  static ColumnSweep of(const Sweep& sweep, const Lattice& lattice, int i, int j);
  bool touches() const { return nearest < local.shape->radius; }
  LocalSweep in_brick(const Lattice& lattice, int k) const;
  /// The whole of the cells between two heights is taken, with more margin than rounding.
  bool takes_all(double low, double high) const;
};

/// Calls f(i, j) for the columns under the box of a sweep.
template <class F>
void each_column(const Sweep& sweep, const Lattice& lattice, F f) {
  int from[2], to[2];
  for (int a = 0; a < 2; ++a) {
    const double r = sweep.outline->radius() + sweep_margin, size = lattice.brick_size();
    double low = std::min(sweep.start[a], sweep.end[a]) - r;
    double high = std::max(sweep.start[a], sweep.end[a]) + r;
    if (sweep.tilted) {
      low = sweep.tilted->box().min()[a];
      high = sweep.tilted->box().max()[a];
    }
    const double last = lattice.bricks[static_cast<std::size_t>(a)] - 1;
    if (high < 0 || low > (last + 1) * size) return;
    from[a] = static_cast<int>(std::clamp(std::floor(low / size), 0.0, last));
    to[a] = static_cast<int>(std::clamp(std::floor(high / size), 0.0, last));
  }
  for (int j = from[1]; j <= to[1]; ++j)
    for (int i = from[0]; i <= to[0]; ++i) f(i, j);
}

}  // namespace aircut::stock
