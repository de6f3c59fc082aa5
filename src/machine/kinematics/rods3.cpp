// Three rods and a platform that keeps its attitude:
//
//   tripod, tripod-inverted   three struts of changing length from fixed anchors
//   delta-linear              three rods of one length on vertical towers
//   triglide                  three rods on parallel level rails
//
//      o carriage c_i = o_i + u_i q_i       With P the platform point, w = P + b_i − o_i and t =
//      w·u_i:
//       \  L_i                                 strut  q = |w|
//        o  platform joint P + b_i             rail   q = t ± √(L² − |w − t u|²)
//
// Forward, P is where three spheres about c_i − b_i meet: the upper or the lower of two points. The
// two come together when P is in the plane of the centres; a guard keeps travel bounds clear of it.
// Joints: q1 q2 q3 (tripod-inverted: and A B C, passed through). Passive: platform_x, platform_y,
// platform_z (P in M) and, when the tree has them, the rods' angles.
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"

namespace aircut::machine {

namespace {

struct ThreeRods {
  std::string_view name;
  std::array<Rod, 3> rods;
  double root = -1;  ///< P is the lower (−1) or the upper (+1) point
  bool drawn = false;
  Vec3 gauge = Vec3::Zero();  ///< gauge point seen from P
};

template <int passed>
struct Rods3 : BasicModel {
  static constexpr int joints = 3 + passed, passives = 9, guards = 1;
  ThreeRods g;

  std::string_view type() const { return g.name; }
  AxisSet axes() const { return axes_of(passed ? "XYZABC" : "XYZ"); }
  std::vector<std::string> passive_names() const {
    std::vector<std::string> names = {"platform_x", "platform_y", "platform_z"};
    if (g.drawn) add_rod_names(3, names);
    return names;
  }
  int passive_count() const { return g.drawn ? 9 : 3; }

  template <class T>
  Vector<T> platform(const PoseWords<T>& tip, const Vec3& tool) const {
    Vector<T> P;
    for (std::size_t i = 0; i < 3; ++i) {
      const double shift = tool[static_cast<int>(i)] - g.gauge[static_cast<int>(i)];
      P[i] = shift == 0 ? tip[i] : tip[i] + T(shift);
    }
    return P;
  }

  template <class T>
  std::array<T, joints + passives + guards> solve(const PoseWords<T>& tip, const Vec3& tool,
                                                  int) const {
    using std::sqrt;
    const Vector<T> P = platform(tip, tool);
    std::array<T, joints + passives + guards> q{};
    std::array<Vector<T>, 3> centres;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rod& rod = g.rods[i];
      const Vector<T> w = P + vector_of<T>(rod.joint - rod.base);
      q[i] = rod_joint(rod, w);
      const Vector<T> c = carriage(rod, q[i]);
      centres[i] = c - vector_of<T>(rod.joint);
      if (g.drawn) rod_angles(P - centres[i], g.root, q[joints + 3 + 2 * i], q[joints + 4 + 2 * i]);
      q[joints + i] = P[i];
    }
    for (std::size_t i = 0; i < passed; ++i) q[3 + i] = tip[3 + i];
    q[joints + passives] = sqrt(root_guard(centres, P, g.root));
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    const Vector<double> P = platform(tip, tool);
    std::array<Vector<double>, 3> centres;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rod& rod = g.rods[i];
      const Vec3 w = vec3(P) + rod.joint - rod.base;
      if (auto error = why_no_rod(rod, static_cast<int>(i) + 1, w)) return error;
      const double q = rod_joint(rod, Vector<double>{w.x(), w.y(), w.z()});
      centres[i] = carriage(rod, q) - vector_of<double>(rod.joint);
    }
    return why_not_root(centres, P, g.root);
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    std::array<Vec3, 3> centres;
    std::array<double, 3> radii{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Rod& rod = g.rods[i];
      const double value = q[static_cast<Eigen::Index>(i)];
      if (rod.is_strut() && !(value > 0))
        return unexpected(ReachError{"strut " + std::to_string(i + 1) + " has the length " +
                                     shortest(value) + "; it must be more than 0"});
      centres[i] = vec3(carriage(rod, value)) - rod.joint;
      radii[i] = rod.is_strut() ? value : rod.length;
    }
    const auto P = three_spheres(centres, radii, g.root);
    if (!P) return unexpected(ReachError{P.error()});
    for (std::size_t i = 0; i < 3; ++i) {
      const Rod& rod = g.rods[i];
      const double lag = rod.side * rod.rail.dot(centres[i] - *P);
      if (!rod.is_strut() && lag < 0)
        return unexpected(ReachError{"carriage " + std::to_string(i + 1) + " is " + fixed(-lag, 3) +
                                     " mm on the other side of the platform's joint"});
    }
    AxisValues tip;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      tip[all_axes[k]] = (*P)[i] + g.gauge[i] - tool[i];
      if (passed) tip[all_axes[3 + k]] = q[3 + i % passed];
    }
    return tip;
  }
};

std::shared_ptr<const Kinematics> three(const Parameters& p, const ThreeRods& g) {
  if (!p.good()) return nullptr;
  return make_model(Rods3<0>{{}, g});
}

// What every machine of this file has.
ThreeRods start(Parameters& p, std::string_view name, double root) {
  ThreeRods g;
  g.name = name;
  g.root = root;
  g.drawn = p.drawn("rod");
  g.gauge = p.point("gauge", Vec3::Zero());
  return g;
}

void read_anchors(Parameters& p, ThreeRods& g) {
  const double bx = p.positive("bx", 1000), cx = p.length("cx", 500), cy = p.length("cy", 900);
  if (cy == 0) p.fail("cy", "'cy' must not be 0: the three anchors would be in one line");
  g.rods[1].base = Vec3(bx, 0, 0);
  g.rods[2].base = Vec3(cx, cy, 0);
}

}  // namespace

std::shared_ptr<const Kinematics> read_tripod(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  ThreeRods g = start(p, "tripod", p.choice("root", {"upper", "lower"}) == "upper" ? 1 : -1);
  read_anchors(p, g);
  return three(p, g);
}

std::shared_ptr<const Kinematics> read_tripod_inverted(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTTRRR");
  ThreeRods g = start(p, "tripod-inverted", -1);
  read_anchors(p, g);
  if (!p.good()) return nullptr;
  return make_model(Rods3<3>{{}, g});
}

std::shared_ptr<const Kinematics> read_delta_linear(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  ThreeRods g = start(p, "delta-linear", -1);
  const double radius = p.positive("radius", 130.25), rod = p.positive("rod", 269);
  for (std::size_t i = 0; i < 3; ++i) {
    const double azimuth = (90 + 120.0 * static_cast<double>(i)) * std::numbers::pi / 180;
    g.rods[i].base = radius * Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    g.rods[i].rail = Vec3::UnitZ();
    g.rods[i].length = rod;
  }
  return three(p, g);
}

std::shared_ptr<const Kinematics> read_triglide(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  ThreeRods g = start(p, "triglide", -1);
  const auto bases = p.points("rails", {{0, -250, 0}, {0, 0, 0}, {0, 250, 0}});
  const auto ends = p.points("platform", {{-40, -50, 0}, {40, 0, 0}, {-40, 50, 0}});
  const Vec3 rail = p.direction("direction", Vec3::UnitX());
  const double rod = p.positive("rod", 500);
  const bool inner = p.choice("middle", {"ahead", "behind"}) == "ahead";
  for (std::size_t i = 0; i < 3; ++i)
    g.rods[i] = {bases[i], rail, rod, ends[i], (i == 1) == inner ? 1.0 : -1.0};
  return three(p, g);
}

}  // namespace aircut::machine
