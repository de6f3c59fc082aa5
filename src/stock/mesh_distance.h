// How far points are from the surface of a closed mesh. Private to stock.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::stock {

class MeshDistance {
 public:
  explicit MeshDistance(std::shared_ptr<const TriangleMesh> mesh);

  /// From the nearest point of the surface, mm. `bound`: a distance that is known not to be passed
  /// (the nearer it is, the less is looked at).
  double distance(const Vec3& p, double bound = std::numeric_limits<double>::infinity()) const;
  /// Whether the surface winds around the point.
  bool inside(const Vec3& p) const;
  /// Negative inside.
  double outside(const Vec3& p, double bound = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  ///< of its triangles in order_, or of its two children
    std::uint32_t count = 0;  ///< 0: it has children
  };
  void build(std::size_t node, std::uint32_t first, std::uint32_t count,
             const std::vector<Vec3>& centres);
  double to_triangle(const Vec3& p, std::uint32_t triangle) const;  ///< squared
  bool winding(const Vec3& p, const Vec3& way, int& out) const;

  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace aircut::stock
