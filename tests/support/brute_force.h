// A slow, obvious second way to the answers of the collide library: all triangle pairs, points in
// time as dense as a micrometre of motion. Shares no code with it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

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

/// The two triangles that are nearest to each other: a start for the next look.
struct Nearest {
  std::size_t here = 0, there = 0;
};

/// A closed mesh whose triangles are put into groups, each with a ball about it, so that many of
/// them can be passed over at once where none of them can matter.
class Solid {
 public:
  explicit Solid(const TriangleMesh& mesh);
  /// Distance of the surfaces, `other` placed by X; 0 where they meet.
  double to(const Solid& other, const Pose& X, Nearest& nearest) const;
  /// Whether a point is inside.
  bool holds(const Vec3& p) const;
  /// One corner of each connected set of triangles.
  const std::vector<Vec3>& shell_corners() const { return shell_corners_; }

 private:
  struct Group {
    Vec3 centre;
    double radius;
    std::size_t begin, end;     ///< of its triangles
    std::size_t first, second;  ///< its halves; 0: it has none
  };
  std::size_t group(std::size_t begin, std::size_t end);

  std::vector<std::array<Vec3, 3>> triangles_;
  std::vector<Group> groups_;
  std::vector<Vec3> shell_corners_;
  Box3 box_;
};

/// Distance of two solids; 0 where they overlap or one is inside of the other.
double distance(const Solid& a, const Solid& b, const Pose& X_AB, Nearest& nearest);

struct Sampled {
  double smallest = 0;  ///< smallest distance at the sampled times; 0 at an overlap
  double t_smallest = 0;
  std::optional<double> first_overlap;  ///< first sampled time with an overlap
  int samples = 0;
};
/// Samples the motion of B seen from A, which is nowhere faster than `speed` mm/s. Two samples are
/// `step` mm of motion apart, or as far as the distance of the bodies: nothing can happen within
/// it. Stops at the first overlap.
Sampled sample_motion(const Solid& a, const Solid& b, const std::function<Pose(double)>& X_AB,
                      double t0, double t1, double speed, double step);

}  // namespace aircut::brute_force
