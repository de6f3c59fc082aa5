// A slow, obvious second way to the answers of the collide library: all triangle pairs, points in
// time as dense as a micrometre of motion. Shares no code with it.
#pragma once

#include <functional>
#include <optional>

#include "geometry/geometry.h"

namespace aircut::brute_force {

/// Distance of the surfaces over all pairs of triangles, mm; 0 when a pair intersects.
double surface_distance(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                        const Pose& X_WB);
/// Whether any pair of triangles has common points.
bool surfaces_meet(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                   const Pose& X_WB);
/// Whether a point is inside of a closed mesh, by solid angle.
bool inside(const TriangleMesh& mesh, const Vec3& p);
/// Surfaces meet, or a corner of one is inside of the other.
bool overlap(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB);

/// Largest distance of a corner of one mesh, inside of the other, from the other's surface; a lower
/// bound of the depth of an overlap. 0 when no corner is inside.
double corner_depth(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b,
                    const Pose& X_WB);

struct Sampled {
  double smallest = 0;  ///< smallest distance at the sampled times; 0 at an overlap
  double t_smallest = 0;
  std::optional<double> first_overlap;  ///< first sampled time with an overlap
  int samples = 0;
};
/// Samples the motion of B seen from A, which is nowhere faster than `speed` mm/s. Two samples are
/// `step` mm of motion apart, or as far as the distance of the bodies: nothing can happen within
/// it. Stops at the first overlap.
Sampled sample_motion(const TriangleMesh& a, const TriangleMesh& b,
                      const std::function<Pose(double)>& X_AB, double t0, double t1, double speed,
                      double step);

}  // namespace aircut::brute_force
