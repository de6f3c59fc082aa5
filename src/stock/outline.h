// A convex solid of revolution as the kernels need it. Private to stock.
#pragma once

#include <vector>

#include "stock/kernel.h"
#include "stock/stock.h"

namespace aircut::stock {

/// A part of the outline between two heights: straight, or an arc with its middle at (e, f) that
/// bulges outwards. The radius grows or shrinks over the whole of it, never both.
struct Band {
  double z0 = 0, z1 = 0;  ///< z0 < z1
  double r0 = 0, r1 = 0;
  double arc = 0;  ///< radius of the arc; 0: straight
  double e = 0, f = 0;

  double radius_at(double z) const;
};

/// A part of the surface seen from below: height p over the radius d in [inner, outer],
/// p = z + slope (d − inner), or p = f − √(arc² − (d − e)²).
struct Floor {
  double inner = 0, outer = 0;
  double z = 0, slope = 0;
  double arc = 0, e = 0, f = 0;

  double height_at(double d) const;
};

/// One convex body: its bands from the bottom up, and its two sides as functions of the radius.
class Outline {
 public:
  /// The bands must join and make a convex body.
  explicit Outline(std::vector<Band> bands);

  const std::vector<Band>& bands() const { return bands_; }
  const std::vector<Floor>& below() const { return below_; }
  /// The upper side, seen from above: heights with the opposite sign.
  const std::vector<Floor>& above() const { return above_; }

  double low() const { return bands_.front().z0; }
  double high() const { return bands_.back().z1; }
  double radius() const { return radius_; }
  double wall_low() const { return wall_low_; }    ///< the radius is the largest from here …
  double wall_high() const { return wall_high_; }  ///< … to here

  const ShapeF& floats() const { return floats_; }

  /// Height of the lower side at radius d (infinite outside).
  double floor_at(double d) const;
  /// Height of the upper side (minus infinite outside).
  double roof_at(double d) const;
  /// Radius at height z, −1 outside.
  double radius_at(double z) const;
  /// The largest radius between two heights, −1 when the body is not there.
  double widest_between(double z0, double z1) const;

 private:
  std::vector<Band> bands_;
  std::vector<Floor> below_, above_;
  double radius_ = 0, wall_low_ = 0, wall_high_ = 0;
  ShapeF floats_;
};

}  // namespace aircut::stock
