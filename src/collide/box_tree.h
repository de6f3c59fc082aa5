// A tree of axis-parallel boxes over the triangles of a mesh. Private to the collide library.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "collide/triangle_pair.h"
#include "geometry/mesh.h"

namespace aircut::collide {

/// Box by centre and half size.
struct CentredBox {
  Vec3 centre = Vec3::Zero(), half = Vec3::Zero();
};

class BoxTree {
 public:
  /// `mesh` has at least one triangle; `solid[i]` says whether triangle i belongs to a closed
  /// shell.
  BoxTree(const TriangleMesh& mesh, const std::vector<char>& solid);

  struct Node {
    CentredBox box;
    /// Inner node: the left child is the next node, `right` the other one. Leaf: `count` triangles
    /// from `first`.
    std::uint32_t right = 0;
    std::uint32_t first = 0, count = 0;
    bool is_leaf() const { return count > 0; }
  };
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  const Triangle& triangle(std::uint32_t i) const { return triangles_[i]; }
  const Vec3& unit_normal(std::uint32_t i) const { return normals_[i]; }

  /// Whether p is inside of the closed shells.
  bool inside(const Vec3& p) const;
  /// Whether a triangle is within `reach` of p.
  bool surface_within(const Vec3& p, double reach) const;
  /// Unit normals of the triangles within `reach` of p.
  std::vector<Vec3> normals_near(const Vec3& p, double reach) const;
  /// Distance along the ray to the nearest triangle, in units of `direction`; nothing when it
  /// misses all. Triangles nearer than `from` don't count.
  std::optional<double> first_hit(const Vec3& origin, const Vec3& direction, double from) const;

 private:
  /// Calls visit(triangle) for those within `reach` of p until it returns false.
  template <class Visit>
  void for_near(const Vec3& p, double reach, Visit&& visit) const;
  std::uint32_t build(const std::vector<Triangle>& source, std::vector<std::uint32_t>& order,
                      std::uint32_t begin, std::uint32_t end);
  /// How often the ray leaves closed shells less how often it enters them; nothing when it runs too
  /// close to an edge.
  std::optional<int> crossings(const Vec3& origin, const Vec3& direction) const;
  double winding(const Vec3& p) const;

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3> normals_;
  std::vector<char> solid_;
};

/// A tree in the frame of A and another one placed by X_AB.
struct TreePair {
  const BoxTree& a;
  const BoxTree& b;
  Mat3 R;      ///< of X_AB
  Mat3 abs_R;  ///< its absolute values
  Vec3 p;      ///< origin of B in A

  TreePair(const BoxTree& tree_a, const BoxTree& tree_b, const Pose& X_AB)
      : a(tree_a), b(tree_b), R(X_AB.linear()), abs_R(R.cwiseAbs()), p(X_AB.translation()) {}

  /// Squared lower bound of the distance of two boxes.
  double box_gap(const CentredBox& box_a, const CentredBox& box_b) const {
    const Vec3 in_a = R * box_b.centre + p - box_a.centre;
    const Vec3 in_b = R.transpose() * in_a;
    const Vec3 gap_a = (in_a.cwiseAbs() - box_a.half - abs_R * box_b.half).cwiseMax(0.0);
    const Vec3 gap_b =
        (in_b.cwiseAbs() - box_b.half - abs_R.transpose() * box_a.half).cwiseMax(0.0);
    return std::max(gap_a.squaredNorm(), gap_b.squaredNorm());
  }
  Triangle triangle_b_in_a(std::uint32_t i) const {
    const Triangle& t = b.triangle(i);
    return {Vec3(R * t[0] + p), Vec3(R * t[1] + p), Vec3(R * t[2] + p)};
  }
};

/// How far from the truth a distance may stay: parts of the trees that can't improve it by more
/// than this aren't looked at.
struct Tolerance {
  double relative = 0;  ///< share of the distance, below 1
  double absolute = 0;  ///< mm
};
struct Nearest {
  ClosestPoints points;  ///< of a true pair: an upper bound
  double low = 0;        ///< lower bound of the distance, mm; at most the tolerance below
};
/// A nearest pair of triangles nearer than `bound`, in A's frame; nothing when there is none.
std::optional<Nearest> nearest(const TreePair& pair, double bound, const Tolerance& tolerance);

/// Calls visit(triangle of A, triangle of B in A's frame) for pairs whose boxes are within `reach`,
/// until it returns false.
template <class Visit>
void for_near_pairs(const TreePair& pair, double reach, Visit&& visit) {
  struct Open {
    std::uint32_t a, b;
  };
  std::vector<Open> open = {{0, 0}};
  const double reach2 = reach * reach;
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const BoxTree::Node &na = pair.a.node(at.a), &nb = pair.b.node(at.b);
    if (pair.box_gap(na.box, nb.box) > reach2) continue;
    if (na.is_leaf() && nb.is_leaf()) {
      for (std::uint32_t k = nb.first; k < nb.first + nb.count; ++k) {
        const Triangle tb = pair.triangle_b_in_a(k);
        for (std::uint32_t i = na.first; i < na.first + na.count; ++i)
          if (!visit(pair.a.triangle(i), tb)) return;
      }
    } else if (nb.is_leaf() ||
               (!na.is_leaf() && na.box.half.squaredNorm() >= nb.box.half.squaredNorm())) {
      open.push_back({na.right, at.b});
      open.push_back({at.a + 1, at.b});
    } else {
      open.push_back({at.a, nb.right});
      open.push_back({at.a, at.b + 1});
    }
  }
}

}  // namespace aircut::collide
