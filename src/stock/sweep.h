// One convex body on a straight path, as the columns of bricks see it. Private to stock.
#pragma once

#include "stock/outline.h"
#include "stock/solid.h"
#include "stock/tilted.h"

namespace aircut::stock {

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

}  // namespace aircut::stock
