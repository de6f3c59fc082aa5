// Motions and random bodies for the tests of the collide library.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "collide/collide.h"

namespace aircut::collide {

/// B turns about an axis through a point of its own and shifts, both evenly over [0, 1].
struct Screw {
  Pose start = Pose::Identity();
  Vec3 shift = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();   ///< unit vector, in A
  Vec3 centre = Vec3::Zero();  ///< on the axis, in A, goes along with the shift
  double angle = 0;            ///< rad
  double radius = 0;           ///< largest distance of a point of B from the axis

  Pose at(double t) const {
    return translation(centre + t * shift) * Pose(Eigen::AngleAxisd(t * angle, axis)) *
           translation(-centre) * start;
  }
  double travel(double ta, double tb) const {
    return (tb - ta) * (shift.norm() + std::abs(angle) * radius);
  }
  RelativeMotion motion() const {
    return {.X_AB = [*this](double t) -> std::optional<Pose> { return at(t); },
            .travel = [*this](double ta, double tb) -> std::optional<double> {
              return travel(ta, tb);
            }};
  }
};

inline Screw slide(const Vec3& from, const Vec3& to) {
  return {.start = translation(from), .shift = to - from};
}

inline double radius_about_axis(const TriangleMesh& mesh, const Screw& screw) {
  double r = 0;
  for (const Vec3& v : mesh.vertices)
    r = std::max(r, (screw.start * v - screw.centre).cross(screw.axis).norm());
  return r;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// The same on every library: no std distribution.
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  int pick(int n) { return static_cast<int>(uniform(0, n)); }
  Vec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  Vec3 direction() {
    while (true) {
      const Vec3 v = in_box(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Pose turned() {
    const Vec3 axis = direction();
    return Pose(Eigen::AngleAxisd(uniform(0, 6.28), axis));
  }

 private:
  std::mt19937 engine_;
};

inline TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  TriangleMesh mesh{{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  if (volume(mesh) < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A small closed body: box, plate, tetrahedron, prism or an L of two boxes.
inline TriangleMesh random_body(Random& random) {
  switch (random.pick(5)) {
    case 0: {
      const Vec3 half = random.in_box(2).cwiseAbs() + Vec3::Constant(0.2);
      return make_box(-half, half);
    }
    case 1:
      return make_box({-2, -2, -0.01}, {2, 2, 0.01});
    case 2: {
      const Vec3 a = random.in_box(2), b = random.in_box(2), c = random.in_box(2);
      return tetrahedron(a, b, c, a + random.uniform(0.5, 3) * (b - a).cross(c - a).normalized());
    }
    case 3:
      return revolve({{random.uniform(0, 1), -1}, {1.2, random.uniform(-0.9, 0.9)}, {0.3, 1.5}},
                     0.5);
    default: {
      TriangleMesh mesh = make_box({-2, -0.5, -0.5}, {-1, 2, 0.5});
      append(mesh, make_box({-0.9, -0.5, -0.5}, {2, 0.5, 0.5}));
      return mesh;
    }
  }
}

/// A closed star-shaped body with dents, about 4 mm across, of `triangles` triangles or a few less:
/// points on circles of latitude, their distance from the middle a sum of waves.
inline TriangleMesh bumpy_ball(Random& random, int triangles) {
  const int round = std::max(4, static_cast<int>(std::sqrt(triangles)));
  const int rings = std::max(2, triangles / (2 * round));
  const double depth = random.uniform(0, 0.5), squeeze = random.uniform(0.2, 1);
  const int waves = 1 + random.pick(6), more = 1 + random.pick(6);
  constexpr double pi = 3.14159265358979;
  TriangleMesh out;
  const auto point = [&](double latitude, double longitude) {
    const double r = 2 * (1 + depth * std::sin(waves * longitude) * std::sin(latitude) *
                                  std::cos(more * latitude));
    out.vertices.emplace_back(r * std::sin(latitude) * std::cos(longitude),
                              r * std::sin(latitude) * std::sin(longitude),
                              squeeze * r * std::cos(latitude));
  };
  point(0, 0);
  for (int i = 1; i <= rings; ++i)
    for (int k = 0; k < round; ++k) point(pi * i / (rings + 1), 2 * pi * k / round);
  point(pi, 0);
  const auto at = [&](int ring, int k) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * round + k % round);
  };
  const auto last = static_cast<std::uint32_t>(out.vertices.size() - 1);
  for (int k = 0; k < round; ++k) {
    out.triangles.push_back({0, at(1, k), at(1, k + 1)});
    for (int i = 1; i < rings; ++i) {
      out.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      out.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
    out.triangles.push_back({at(rings, k), last, at(rings, k + 1)});
  }
  return out;
}

}  // namespace aircut::collide
