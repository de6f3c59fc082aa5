// A direction that two turns bring to another one (Paden and Kahan's second problem).
#pragma once

#include <optional>
#include <vector>

#include "geometry/geometry.h"

namespace aircut::machine {

/// Angle about the unit vector u that brings a to b (their parts across u); nothing when one of
/// them is along u, so that any angle does.
std::optional<double> angle_about(const Vec3& u, const Vec3& a, const Vec3& b);

struct TwoTurns {
  std::optional<double> outer, inner;  ///< rad in (−π, π]; nothing: any angle does
};
/// All solutions of R(u1, outer) · R(u2, inner) · p = q for unit vectors: none, one or two.
std::vector<TwoTurns> two_turns(const Vec3& u1, const Vec3& u2, const Vec3& p, const Vec3& q);

}  // namespace aircut::machine
