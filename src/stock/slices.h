// How pieces are in the material at their turn, as the Z rays tell when they are cut. Private to
// stock.
//
// A ray beside the way by y meets the front of a cutter of radius R when the tip is √(R² − y²)
// before the ray's foot on the way. So each ray belongs to one place of the way, and rays are
// gathered in slices of it. Order of cuts: the Z rays of a column are cut in program order, so what
// they tell is what the cutter met; threads have columns of their own, and sums and extremes of
// slices do not depend on the order in which they are put together.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "stock/stock.h"

namespace aircut::stock {

/// What the rays of a slice tell.
struct SliceExtent {
  std::int64_t quanta = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;  ///< over the tip, mm
  double left = -low, right = -low;                                   ///< mm

  void add(const SliceExtent& other) {
    quanta += other.quanta;
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    left = std::max(left, other.left);
    right = std::max(right, other.right);
  }
};

/// A piece whose slices are watched.
struct SliceWatch {
  std::size_t piece = 0, first = 0, count = 0;  ///< its place in the list, and of its slices
  Vec3 start = Vec3::Zero(), way = Vec3::Zero(), axis = Vec3::UnitZ();
  Vec3 ahead = Vec3::Zero(), left = Vec3::Zero();  ///< zero when the tool goes along its axis
  double length = 0, radius = 0;                   ///< in plan, of the cutter

  static SliceWatch of(const Piece& piece, const Vec3& origin, double longest) {
    SliceWatch out;
    out.start = piece.start - origin;
    out.way = piece.end - piece.start;
    out.axis = piece.axis;
    out.radius = piece.cutter->radius();
    const Vec3 plan = out.way - out.way.dot(piece.axis) * piece.axis;
    out.length = plan.norm();
    const double all = out.way.norm();
    if (out.length > 1e-9 && out.length > 1e-6 * all) {
      out.ahead = plan / out.length;
      out.left = piece.axis.cross(out.ahead);
    } else {
      out.length = 0;
    }
    constexpr double most = 1e5;
    out.count = static_cast<std::size_t>(std::clamp(std::ceil(all / longest - 1e-9), 1.0, most));
    return out;
  }

  /// A stretch of a Z ray from `low` to `high` mm at x, y.
  void see(double x, double y, double low, double high, std::int64_t quanta,
           SliceExtent* slices) const {
    const Vec3 from = Vec3(x, y, low) - start, to = Vec3(x, y, high) - start;
    double at = 0;  // fraction of the way
    if (length > 0) {
      const double beside = from.dot(left);
      at = (from.dot(ahead) - std::sqrt(std::max(0.0, radius * radius - beside * beside))) / length;
    } else if (const double all = way.norm(); all > 0) {
      at = std::max(from.dot(way), to.dot(way)) / (all * all);
    }
    at = std::clamp(at, 0.0, 1.0);
    SliceExtent& slice =
        slices[first +
               std::min(count - 1, static_cast<std::size_t>(at * static_cast<double>(count)))];
    slice.quanta += quanta;
    if (length == 0) return;
    for (const Vec3& end : {from, to}) {
      const double t = std::clamp(end.dot(ahead) / length, 0.0, 1.0);
      const double height = (end - t * way).dot(axis), beside = end.dot(left);
      slice.low = std::min(slice.low, height);
      slice.high = std::max(slice.high, height);
      slice.left = std::max(slice.left, beside);
      slice.right = std::max(slice.right, -beside);
    }
  }
};

}  // namespace aircut::stock
