// Two rods in a plane and a third slide across it:
//
//   plotter   a pen on two strings from fixed anchors, in the plane X Y; the third joint is Z
//   biglide   two rods of fixed length on one rail along X, in the plane X Z; the third joint is Y
//
//   o anchor 1      anchor 2 o      o===[slider 1]========[slider 2]===o
//     \            /                        \              /
//       \        /                       L1  \            /  L2
//          \  /                                o—platform—o
//           P   (below)                            P
//
// Inverse as for other rods (rods.h). Forward, P is the crossing of two circles: the one below the
// line of their centres. Where P is in that line the two crossings meet; a guard keeps clear of it.
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"

namespace aircut::machine {

namespace {

struct PlanarRods : BasicModel {
  static constexpr int joints = 3, passives = 4, guards = 1;
  std::string_view name;
  std::array<Rod, 2> rods;
  std::size_t down = 1, across = 2;  ///< the axis against which P hangs, and the third one
  bool drawn = false;
  Vec3 gauge = Vec3::Zero();

  std::string_view type() const { return name; }
  AxisSet axes() const { return axes_of("XYZ"); }
  std::vector<std::string> passive_names() const {
    std::vector<std::string> names = {"platform_x", down == 1 ? "platform_y" : "platform_z"};
    if (drawn) names.insert(names.end(), {"rod1_angle", "rod2_angle"});
    return names;
  }
  int passive_count() const { return drawn ? 4 : 2; }

  template <class T>
  Vector<T> platform(const PoseWords<T>& tip, const Vec3& tool) const {
    Vector<T> P;
    for (int i = 0; i < 3; ++i)
      P[static_cast<std::size_t>(i)] = tip[static_cast<std::size_t>(i)] + T(tool[i] - gauge[i]);
    return P;
  }

  // Where rod i would meet the platform point if its joint were there, at joint value q.
  template <class T>
  Vector<T> centre(std::size_t i, const T& q) const {
    return carriage(rods[i], q) - vector_of<T>(rods[i].joint);
  }

  // mm², positive with P below the line of the centres in their order along X.
  template <class T>
  T below(const Vector<T>& c1, const Vector<T>& c2, const Vector<T>& P) const {
    const Vector<T> a = c2 - c1, b = P - c1;
    return (a[down] * b[0] - a[0] * b[down]) * a[0];
  }

  template <class T>
  std::array<T, joints + passives + guards> solve(const PoseWords<T>& tip, const Vec3& tool,
                                                  int) const {
    using std::atan2;
    using std::sqrt;
    const Vector<T> P = platform(tip, tool);
    Vector<T> flat = P;
    flat[across] = T(0);
    std::array<T, joints + passives + guards> q{};
    std::array<Vector<T>, 2> centres;
    for (std::size_t i = 0; i < 2; ++i) {
      q[i] = rod_joint(rods[i], flat + vector_of<T>(rods[i].joint - rods[i].base));
      centres[i] = centre(i, q[i]);
      const Vector<T> d = flat - centres[i];
      // About +Y (or −Z): zero hangs straight down, the direction is (−sin φ, −cos φ).
      if (drawn) q[joints + 2 + i] = atan2(-d[0], -d[down]);
    }
    q[2] = P[across];
    q[joints] = P[0];
    q[joints + 1] = P[down];
    q[joints + passives] = sqrt(below(centres[0], centres[1], flat));
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    Vector<double> flat = platform(tip, tool);
    flat[across] = 0;
    std::array<Vector<double>, 2> centres;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector<double> w = flat + vector_of<double>(rods[i].joint - rods[i].base);
      if (auto error = why_no_rod(rods[i], static_cast<int>(i) + 1, vec3(w))) return error;
      centres[i] = centre(i, rod_joint(rods[i], w));
    }
    if (below(centres[0], centres[1], flat) > 1e-6) return std::nullopt;
    return std::string(
        "the platform is not below the line of the rods' other ends, where it would hang");
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    const Vector<double> c1 = centre(0, q[0]), c2 = centre(1, q[1]);
    const double r1 = rods[0].is_strut() ? q[0] : rods[0].length;
    const double r2 = rods[1].is_strut() ? q[1] : rods[1].length;
    if (!(r1 > 0 && r2 > 0)) return unexpected(ReachError{"the strings must be longer than 0"});
    const double vx = c2[0] - c1[0], vz = c2[down] - c1[down], d = std::hypot(vx, vz);
    const double a = ((r1 - r2) * (r1 + r2) + d * d) / (2 * d), h2 = (r1 - a) * (r1 + a);
    if (!(d > 1e-9) || !(h2 >= 0))
      return unexpected(ReachError{"the rods don't meet: their ends are " + fixed(d, 3) +
                                   " mm apart and they reach from " + fixed(std::abs(r1 - r2), 3) +
                                   " to " + fixed(r1 + r2, 3) + " mm"});
    const double h = std::sqrt(h2) * (vx >= 0 ? 1 : -1), ux = vx / d, uz = vz / d;
    Vec3 P = Vec3::Zero();
    P[0] = c1[0] + a * ux + h * uz;
    P[static_cast<int>(down)] = c1[down] + a * uz - h * ux;
    for (std::size_t i = 0; i < 2; ++i) {
      const double lag = rods[i].side * ((i ? c2 : c1)[0] - P[0]);
      if (!rods[i].is_strut() && lag < 0)
        return unexpected(ReachError{"slider " + std::to_string(i + 1) + " is " + fixed(-lag, 3) +
                                     " mm on the other side of the platform's joint"});
    }
    P[static_cast<int>(across)] = q[2];
    P += gauge - tool;
    AxisValues tip;
    for (int i = 0; i < 3; ++i) tip[all_axes[static_cast<std::size_t>(i)]] = P[i];
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_plotter(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  PlanarRods model;
  model.name = "plotter";
  model.gauge = p.point("gauge", Vec3::Zero());
  model.drawn = p.drawn("rod");
  model.rods[0].base = p.point("anchor1", Vec3(0, 0, 0));
  model.rods[1].base = p.point("anchor2", Vec3(1000, 0, 0));
  for (Rod& rod : model.rods) rod.base.z() = 0;
  if (!(model.rods[1].base.x() > model.rods[0].base.x()))
    p.fail("anchor2", "anchor 2 must be on the right (+X) of anchor 1");
  return p.good() ? make_model(model) : nullptr;
}

std::shared_ptr<const Kinematics> read_biglide(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTT");
  PlanarRods model;
  model.name = "biglide";
  model.down = 2;
  model.across = 1;
  model.gauge = p.point("gauge", Vec3::Zero());
  model.drawn = p.drawn("rod");
  const double half = p.length("platform", 120) / 2, rod1 = p.positive("rod1", 400),
               rod2 = p.positive("rod2", 400);
  model.rods[0] = {Vec3::Zero(), Vec3::UnitX(), rod1, Vec3(-half, 0, 0), -1};
  model.rods[1] = {Vec3::Zero(), Vec3::UnitX(), rod2, Vec3(half, 0, 0), 1};
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
