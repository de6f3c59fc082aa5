// The vector z between the two turns has known parts along u1 and u2, since each turn keeps the
// part along its own axis, and up to a sign along u1 × u2 because it is a unit vector:
//
//   z = α u1 + β u2 ± γ (u1 × u2)
//
// (kinematics.md d.5). Then inner turns p to z and outer turns z to q.
#include "machine/rotation/two_turns.h"

#include <algorithm>
#include <cmath>

namespace aircut::machine {

std::optional<double> angle_about(const Vec3& u, const Vec3& a, const Vec3& b) {
  const Vec3 p = a - u.dot(a) * u, q = b - u.dot(b) * u;
  if (p.norm() < 1e-9 || q.norm() < 1e-9) return std::nullopt;
  return std::atan2(u.dot(p.cross(q)), p.dot(q));
}

std::vector<TwoTurns> two_turns(const Vec3& u1, const Vec3& u2, const Vec3& p, const Vec3& q) {
  const double g = u1.dot(u2);
  const Vec3 across = u1.cross(u2);
  if (across.norm() < 1e-9) return {};
  const double alpha = (g * u2.dot(p) - u1.dot(q)) / (g * g - 1);
  const double beta = (g * u1.dot(q) - u2.dot(p)) / (g * g - 1);
  const double gamma2 =
      (1 - alpha * alpha - beta * beta - 2 * alpha * beta * g) / across.squaredNorm();
  if (gamma2 < -1e-12) return {};
  const double gamma = std::sqrt(std::max(gamma2, 0.0));
  std::vector<TwoTurns> out;
  for (const double sign : {1.0, -1.0}) {
    const Vec3 z = alpha * u1 + beta * u2 + sign * gamma * across;
    out.push_back({angle_about(u1, z, q), angle_about(u2, p, z)});
    if (gamma < 1e-9) break;
  }
  return out;
}

}  // namespace aircut::machine
