// Two triangles: their distance, and how deep they cut each other. Private to the collide library.
#pragma once

#include <array>

#include "geometry/pose.h"

namespace aircut::collide {

using Triangle = std::array<Vec3, 3>;

struct ClosestPoints {
  double squared = 0;  ///< squared distance, mm²
  Vec3 on_a, on_b;
};
/// Closest points of two triangles; squared distance 0 with a common point when they intersect.
ClosestPoints closest_points(const Triangle& a, const Triangle& b);

/// Gap of the triangles' ranges along a unit vector, a lower bound of their distance; negative when
/// the ranges overlap, mm.
double gap_along(const Vec3& unit, const Triangle& a, const Triangle& b);

/// Squared distance of a point from a triangle, mm².
double squared_distance(const Vec3& p, const Triangle& triangle);

struct PairDepth {
  double depth = 0;  ///< smallest shift that separates the two, mm; negative: they are apart
  Vec3 axis = Vec3::UnitZ();  ///< unit vector along which A goes to separate
};
/// Depth by separating axes. Nothing better than `enough_apart` below zero is looked for.
PairDepth pair_depth(const Triangle& a, const Triangle& b, double enough_apart);

}  // namespace aircut::collide
