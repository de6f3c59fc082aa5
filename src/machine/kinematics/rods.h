// Rods of parallel machines: from a carriage on a rail (or a fixed point, when the rod itself gets
// longer and shorter) to a joint on the platform.
//
// Rod angles, for pictures: a rod at angle zero points straight down (or up), and its direction is
// Rx(a)·Ry(b)·(0, 0, ∓1). They are passive values that a package uses for all rods or for none.
#pragma once

#include "machine/kinematics/model.h"

namespace aircut::machine {

struct Rod {
  Vec3 base = Vec3::Zero();   ///< the carriage at q = 0, or the fixed end
  Vec3 rail = Vec3::Zero();   ///< unit vector; zero: the rod's length is the joint value
  double length = 0;          ///< of a rod on a rail
  Vec3 joint = Vec3::Zero();  ///< on the platform, seen from it
  double side = 1;  ///< the carriage is ahead (+1) of the platform's joint, or behind (−1)

  bool is_strut() const { return rail.isZero(); }
};

/// The part of w across a unit vector, by constant rows: entries that are zero add no width.
template <class T>
Vector<T> across(const Vec3& u, const Vector<T>& w) {
  Vector<T> out;
  const Mat3 P = Mat3::Identity() - u * u.transpose();
  for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(i)] = dot(Vec3(P.row(i)), w);
  return out;
}

/// Joint value of a rod whose platform joint is w away from its base.
template <class T>
T rod_joint(const Rod& rod, const Vector<T>& w) {
  using std::sqrt;
  if (rod.is_strut()) return sqrt(squared_norm(w));
  return dot(rod.rail, w) +
         T(rod.side) * sqrt(T(rod.length * rod.length) - squared_norm(across(rod.rail, w)));
}

/// The moving end of the rod on the base's side.
template <class T>
Vector<T> carriage(const Rod& rod, const T& q) {
  Vector<T> out;
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        rod.rail[i] == 0 ? T(rod.base[i]) : T(rod.base[i]) + T(rod.rail[i]) * q;
  return out;
}

/// Angles a, b of a direction; `down` is −1 when rods at angle zero hang.
template <class T>
void rod_angles(const Vector<T>& d, double down, T& a, T& b) {
  using std::atan2;
  using std::sqrt;
  const T s(down);
  a = atan2(-s * d[1], s * d[2]);
  b = atan2(s * d[0], sqrt(square(d[1]) + square(d[2])));
}

/// Why a rod does not reach; nothing when it does.
std::optional<std::string> why_no_rod(const Rod& rod, int number, const Vec3& w);
/// "rod1_a_angle", "rod1_b_angle", … after the names that are there.
void add_rod_names(int count, std::vector<std::string>& names);

/// Where three spheres meet; of the two points the higher (root +1) or the lower one. The error
/// says why they don't.
tl::expected<Vec3, std::string> three_spheres(const std::array<Vec3, 3>& centres,
                                              const std::array<double, 3>& radii, double root);

/// Positive (mm⁵) where P is the point that three_spheres() gives for these centres.
template <class T>
T root_guard(const std::array<Vector<T>, 3>& c, const Vector<T>& P, double root) {
  const Vector<T> normal = cross(c[1] - c[0], c[2] - c[0]);
  return T(root) * dot(normal, P - c[0]) * normal[2];
}
/// Nothing when P keeps clear of the plane of the centres, on the side of `root`.
std::optional<std::string> why_not_root(const std::array<Vector<double>, 3>& c,
                                        const Vector<double>& P, double root);

}  // namespace aircut::machine
