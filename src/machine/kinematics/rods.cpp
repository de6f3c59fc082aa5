#include "machine/kinematics/rods.h"

namespace aircut::machine {

std::optional<std::string> why_no_rod(const Rod& rod, int number, const Vec3& w) {
  // No text is made on the way that is gone for every pose.
  const auto name = [&] { return (rod.is_strut() ? "strut " : "rod ") + std::to_string(number); };
  constexpr double singular_mm = 1e-6;
  if (rod.is_strut()) {
    if (w.squaredNorm() > singular_mm * singular_mm) return std::nullopt;
    return name() + " would have no length: the platform's joint is in its anchor";
  }
  const double distance = (w - rod.rail.dot(w) * rod.rail).norm();
  if (distance > rod.length)
    return name() + " is " + fixed(distance - rod.length, 3) + " mm too short: its joint is " +
           fixed(distance, 3) + " mm from the rail";
  if (!((rod.length - distance) * (rod.length + distance) > singular_mm * singular_mm))
    return name() +
           " is square to its rail, where the carriage would need an infinite speed (a "
           "singular pose)";
  return std::nullopt;
}

void add_rod_names(int count, std::vector<std::string>& names) {
  for (int i = 1; i <= count; ++i)
    for (const char* which : {"_a_angle", "_b_angle"})
      names.push_back("rod" + std::to_string(i) + which);
}

// Spheres 1 and 2 meet in a circle across their line, and so do 1 and 3: the point is in the plane
// of both circles, a foot point in the plane of the centres, at the height that sphere 1 leaves.
tl::expected<Vec3, std::string> three_spheres(const std::array<Vec3, 3>& c,
                                              const std::array<double, 3>& r, double root) {
  const Vec3 to2 = c[1] - c[0], to3 = c[2] - c[0];
  const double d = to2.norm();
  const Vec3 ex = to2 / d;
  const double i = ex.dot(to3);
  const Vec3 rest = to3 - i * ex;
  const double j = rest.norm();
  if (!(d > 1e-9) || !(j > 1e-9))
    return unexpected(std::string("the ends of the three rods are in one line"));
  const Vec3 ey = rest / j, ez = ex.cross(ey);
  const double x = ((r[0] - r[1]) * (r[0] + r[1]) + d * d) / (2 * d);
  const double y = ((r[0] - r[2]) * (r[0] + r[2]) + i * i + j * j) / (2 * j) - i * x / j;
  const double h2 = (r[0] - x) * (r[0] + x) - y * y;
  if (!(h2 >= 0))
    return unexpected("the rods don't meet: their ends would have to come " +
                      fixed(std::sqrt(std::max(0.0, -h2)), 3) + " mm closer");
  const Vec3 foot = c[0] + x * ex + y * ey;
  return foot + (ez.z() * root >= 0 ? 1 : -1) * std::sqrt(h2) * ez;
}

std::optional<std::string> why_not_root(const std::array<Vector<double>, 3>& c,
                                        const Vector<double>& P, double root) {
  const Vec3 normal = vec3(cross(c[1] - c[0], c[2] - c[0]));
  constexpr double clear_mm = 1e-6;
  if (root_guard(c, P, root) > clear_mm * normal.squaredNorm()) return std::nullopt;
  const double h = normal.dot(vec3(P - c[0])) / normal.norm() * (normal.z() >= 0 ? 1 : -1);
  return "the platform is " + fixed(std::abs(h), 3) + " mm " + (h * root >= 0 ? "from" : "beyond") +
         " the plane of the rods' other ends, where it could fall to the other side (a singular "
         "pose)";
}

}  // namespace aircut::machine
