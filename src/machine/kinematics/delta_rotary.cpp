// delta-rotary: three thighs turn about level hips and carry a foot by three shins.
//
//      hip o—thigh        side view of an arm, x' outwards from the middle, y' across:
//         /  θ      \       knee = (hip + thigh cos θ, 0, −thigh sin θ)
//                    o knee   foot joint = (x' + foot, y', z)
//           shin   /        with r = x' + foot − hip, h = √(r² + z²),
//        foot o—o          K = (r² + y'² + z² + thigh² − shin²) / (2 thigh):
//                               r cos θ − z sin θ = K,   θ = −atan2(z, r) − acos(K/h)
//
// the root whose knee is outside. Forward, the foot is where three spheres about the knees (moved
// inwards by the foot's radius) meet, the lower point. Joints: θ1 θ2 θ3 of the arms at azimuth −90,
// 30 and 150 degrees; positive lowers the knee. Passive: platform_x, platform_y, platform_z.
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"

namespace aircut::machine {

namespace {

struct DeltaRotary : BasicModel {
  static constexpr int joints = 3, passives = 3, guards = 1;
  double hip = 254, thigh = 254, shin = 355.6, foot = 152.4;  ///< mm
  Vec3 gauge = Vec3::Zero();

  std::string_view type() const { return "delta-rotary"; }
  AxisSet axes() const { return axes_of("XYZ"); }
  bool rotary(int) const { return true; }
  std::vector<std::string> passive_names() const {
    return {"platform_x", "platform_y", "platform_z"};
  }
  int passive_count() const { return 3; }

  static Vec3 outwards(std::size_t arm) {
    constexpr double c30 = std::numbers::sqrt3 / 2;
    return arm == 0 ? Vec3(0, -1, 0) : Vec3(arm == 1 ? c30 : -c30, 0.5, 0);
  }

  template <class T>
  struct Arm {
    T r, z, K, h;
  };
  template <class T>
  Arm<T> arm(std::size_t i, const Vector<T>& P) const {
    using std::sqrt;
    const Vec3 out = outwards(i), along(-out.y(), out.x(), 0);
    Arm<T> a;
    a.r = dot(out, P) + T(foot - hip);
    a.z = P[2];
    a.h = sqrt(square(a.r) + square(a.z));
    a.K = (square(a.r) + square(dot(along, P)) + square(a.z) + T(thigh * thigh - shin * shin)) *
          T(1 / (2 * thigh));
    return a;
  }

  // The knee, moved inwards by the foot's radius.
  template <class T>
  Vector<T> centre(std::size_t i, const T& angle) const {
    using std::cos;
    using std::sin;
    const Vec3 out = outwards(i);
    const T reach = T(hip - foot) + T(thigh) * cos(angle);
    return {T(out.x()) * reach, T(out.y()) * reach, T(-thigh) * sin(angle)};
  }

  // The same without the angle: cos θ = (K r − d z)/h², sin θ = −(K z + d r)/h², d = √(h² − K²).
  Vector<double> centre(std::size_t i, const Arm<double>& a) const {
    const double d = std::sqrt((a.h - a.K) * (a.h + a.K)), h2 = a.h * a.h;
    const Vec3 out = outwards(i);
    const double reach = hip - foot + thigh * (a.K * a.r - d * a.z) / h2;
    return {out.x() * reach, out.y() * reach, thigh * (a.K * a.z + d * a.r) / h2};
  }

  template <class T>
  std::array<T, joints + passives + guards> solve(const PoseWords<T>& tip, const Vec3& tool,
                                                  int) const {
    using std::acos;
    using std::atan2;
    using std::sqrt;
    const Vec3 shift = tool - gauge;
    const Vector<T> P = Vector<T>{tip[0], tip[1], tip[2]} + vector_of<T>(shift);
    std::array<T, joints + passives + guards> q{};
    std::array<Vector<T>, 3> centres;
    for (std::size_t i = 0; i < 3; ++i) {
      const Arm<T> a = arm(i, P);
      q[i] = atan2(-a.z, a.r) - acos(a.K / a.h);
      q[joints + i] = P[i];
      if constexpr (!std::is_same_v<T, double>) centres[i] = centre(i, q[i]);
    }
    // The guard is there for travel bounds; for plain numbers why_not() has looked at the root.
    if constexpr (!std::is_same_v<T, double>)
      q[joints + passives] = sqrt(root_guard(centres, P, -1));
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    const Vec3 p = Vec3(tip[0], tip[1], tip[2]) + tool - gauge;
    const Vector<double> P = {p.x(), p.y(), p.z()};
    if (!(p.z() < 0)) return std::string("the foot is not below the hips");
    std::array<Vector<double>, 3> centres;
    for (std::size_t i = 0; i < 3; ++i) {
      const Arm<double> a = arm(i, P);
      const std::string name = "arm " + std::to_string(i + 1);
      if (a.K > a.h)
        return name + " is " + fixed(a.K - a.h, 3) + " mm too short (measured along the thigh)";
      if (a.K < -a.h)
        return name + " is folded: the foot is " + fixed(-a.h - a.K, 3) + " mm too near to the hip";
      if (!((a.h - a.K) * (a.h + a.K) > 1e-9))
        return name + " is stretched, where it would need an infinite speed (a singular pose)";
      centres[i] = centre(i, a);
    }
    return why_not_root(centres, P, -1);
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    std::array<Vec3, 3> centres;
    for (std::size_t i = 0; i < 3; ++i)
      centres[i] = vec3(centre(i, static_cast<double>(q[static_cast<Eigen::Index>(i)])));
    const auto P = three_spheres(centres, {shin, shin, shin}, -1);
    if (!P) return unexpected(ReachError{P.error()});
    if (!(P->z() < 0)) return unexpected(ReachError{"the foot is not below the hips"});
    for (std::size_t i = 0; i < 3; ++i) {
      // The knee is outside of the line from hip to foot.
      const Arm<double> a = arm(i, Vector<double>{P->x(), P->y(), P->z()});
      const double angle = q[static_cast<Eigen::Index>(i)];
      const double bend = -std::cos(angle) * a.z - std::sin(angle) * a.r;
      if (bend < 0)
        return unexpected(
            ReachError{"the knee of arm " + std::to_string(i + 1) + " is bent inwards"});
    }
    const Vec3 p = *P + gauge - tool;
    AxisValues tip;
    for (int i = 0; i < 3; ++i) tip[all_axes[static_cast<std::size_t>(i)]] = p[i];
    return tip;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_delta_rotary(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRR");
  DeltaRotary model;
  model.hip = p.positive("hip", model.hip);
  model.thigh = p.positive("thigh", model.thigh);
  model.shin = p.positive("shin", model.shin);
  model.foot = p.length("foot", model.foot);
  model.gauge = p.point("gauge", Vec3::Zero());
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
