// When is an overlap certainly deeper than the contact tolerance ε_c?
//
// The depth of an overlap is the length of the shortest shift that separates the bodies. It is hard
// to compute for meshes, but any of these facts proves that it exceeds ε_c:
//
//  1. Two triangles, one of each body, that need a shift of more than ε_c to come apart
//     (separating axes). Whatever separates the bodies separates them too.
//  2. A point that is inside of both bodies and farther than ε_c from one surface. A shift must
//  bring
//     the point out of that body.
//
// Points for 2: corners of shells and points deep inside, which find a body inside another; and,
// where surfaces only touch (faces that lie in one plane hide an overlap from 1, for example two
// blocks of the same width pushed into each other), points a little below both surfaces:
//
//        A │      │                  c   common point of two touching triangles
//   ───────┼──────c──────            n   outward normals of the faces of A and B that meet in c
//          │  · p │   B              p = c − h Σ n,  h = 2 ε_c and 16 ε_c
#include <algorithm>
#include <cmath>

#include "collide/mesh_impl.h"

namespace aircut::collide {
namespace {

/// Touching places that are looked at; they are many where faces coincide, and much alike.
constexpr std::size_t max_touching = 24;

/// Keeps each direction once; faces of many triangles would outweigh the others.
void add_direction(std::vector<Vec3>& list, const Vec3& n) {
  const auto same = [&](const Vec3& m) { return (m - n).squaredNorm() < 1e-6; };
  if (std::none_of(list.begin(), list.end(), same)) list.push_back(n);
}

class OverlapProof {
 public:
  OverlapProof(const CollisionMesh& a, const CollisionMesh& b, const Pose& X_AB, double touch)
      : a_(a.impl()), b_(b.impl()), X_AB_(X_AB), X_BA_(X_AB.inverse()), touch_(touch) {}

  /// Inside of both, and far enough from one surface. `p` in A's frame.
  bool proves(const Vec3& p) const {
    const Vec3 in_b = X_BA_ * p;
    if (!a_.tree->inside(p) || !b_.tree->inside(in_b)) return false;
    // Closer to a surface than rounding, "inside" means nothing.
    const double sure = std::min(touch_, 1e-6);
    const bool far_a = !a_.tree->surface_within(p, touch_);
    const bool far_b = !b_.tree->surface_within(in_b, touch_);
    return (far_a && (far_b || !b_.tree->surface_within(in_b, sure))) ||
           (far_b && !a_.tree->surface_within(p, sure));
  }

  std::optional<Vec3> by_triangles() {
    std::optional<Vec3> found;
    const double slack = 1e-9 * (a_.radius + b_.radius);
    for_near_pairs(TreePair(*a_.tree, *b_.tree, X_AB_), 0,
                   [&](const Triangle& ta, const Triangle& tb) {
                     const PairDepth pair = pair_depth(ta, tb, slack);
                     if (pair.depth > touch_ + slack)
                       found = closest_points(ta, tb).on_a;
                     else if (pair.depth >= -slack)
                       note_touching(ta, tb);
                     return !found;
                   });
    return found;
  }

  std::optional<Vec3> below_touching_places() const {
    const double near = 1e-7 * (a_.radius + b_.radius);
    for (const Vec3& c : touching_) {
      std::vector<Vec3> of_a, of_b, of_both;
      for (const Vec3& n : a_.tree->normals_near(c, near)) add_direction(of_a, n);
      for (const Vec3& n : b_.tree->normals_near(X_BA_ * c, near))
        add_direction(of_b, X_AB_.linear() * n);
      of_both = of_a;
      for (const Vec3& n : of_b) add_direction(of_both, n);
      for (const auto* normals : {&of_both, &of_a, &of_b}) {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& n : *normals) sum += n;
        for (const double h : {2 * touch_, 16 * touch_}) {
          const Vec3 p = c - h * sum;
          if (proves(p)) return p;
        }
      }
    }
    return std::nullopt;
  }

  std::optional<Vec3> by_known_points() const {
    for (const std::vector<Vec3>* list : {&b_.shell_points, &b_.deep_points})
      for (const Vec3& p : *list)
        if (proves(X_AB_ * p)) return X_AB_ * p;
    for (const std::vector<Vec3>* list : {&a_.shell_points, &a_.deep_points})
      for (const Vec3& p : *list)
        if (proves(p)) return p;
    return std::nullopt;
  }

 private:
  void note_touching(const Triangle& ta, const Triangle& tb) {
    // Thins out: once full, every second place is dropped and only every second one is taken.
    if (seen_++ % stride_ != 0) return;
    if (touching_.size() == max_touching) {
      for (std::size_t i = 0; i < max_touching / 2; ++i) touching_[i] = touching_[2 * i];
      touching_.resize(max_touching / 2);
      stride_ *= 2;
      if ((seen_ - 1) % stride_ != 0) return;
    }
    const ClosestPoints points = closest_points(ta, tb);
    touching_.push_back(0.5 * (points.on_a + points.on_b));
  }

  const CollisionMesh::Impl& a_;
  const CollisionMesh::Impl& b_;
  Pose X_AB_, X_BA_;
  double touch_;
  std::vector<Vec3> touching_;
  std::size_t seen_ = 0, stride_ = 1;
};

}  // namespace

std::optional<Vec3> certain_overlap(const CollisionMesh& a, const CollisionMesh& b,
                                    const Pose& X_AB, double touch) {
  if (!a.impl().tree || !b.impl().tree) return std::nullopt;
  OverlapProof proof(a, b, X_AB, touch);
  if (auto point = proof.by_triangles()) return point;
  if (auto point = proof.by_known_points()) return point;
  return proof.below_touching_places();
}

}  // namespace aircut::collide
