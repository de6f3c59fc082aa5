// Sweeps with a tool axis in any direction. Private to stock.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stock/outline.h"
#include "stock/solid.h"

namespace aircut::stock {

/// A convex body whose axis is not the lattice's Z, on a straight path; lattice frame.
class TiltedSweep {
 public:
  TiltedSweep(const Outline& outline, const Vec3& start, const Vec3& end, const Vec3& axis);

  const Box3& box() const { return box_; }
  double lowest_tip() const { return tip_low_; }  ///< along the axis

  /// Proof that no point of a box is touched.
  bool misses(const Box3& box) const;
  /// Proof that all points of a box are taken, with more margin than rounding.
  bool takes_all(const Box3& box) const;

  /// The chords of a row's rays, like the kernels' (kernel.h).
  bool chords(const Lattice& lattice, const std::array<int, 3>& brick, Family family, int row,
              const std::uint16_t* lo, const std::uint16_t* hi, Chords& out) const;

 private:
  /// `rel` is seen from the path's start; t and place as in TiltedEnds.
  Vec3 normal_at(const Vec3& rel, double t, std::int64_t place) const;
  bool holds(const Vec3& p) const;

  const Outline* outline_;
  std::array<std::vector<TiltedBand>, 3> ray_bands_;  ///< by the rays' axis
  std::vector<Band> bands_;                           ///< corners with e > 0 as cones
  Vec3 start_, travel_, axis_;
  Vec3 way_;                    ///< the travel seen along the axis
  double way2_ = 0, per_way2_;  ///< its square; 1 over it, 0 where there is none
  Box3 box_;
  double tip_low_, tip_high_;  ///< of the tip, along the axis
};

}  // namespace aircut::stock
