// five-bar: two arms of two links each hold one point in the plane X Y; the third joint is Z.
//
//            P              inner links l1, l2 from motors at (∓base/2, 0), outer links m1, m2.
//          /   \            With d the distance of P from a motor and β its direction there:
//     m1 /       \ m2          θ = β ± acos((d² + l² − m²) / (2 d l))
//       o         o         + on the left, − on the right: both elbows outside.
//     l1 \       / l2
//    ——o———————————o——      Forward, P is the crossing of two circles about the elbows that is
//        base               ahead of (left of) the line from elbow 1 to elbow 2.
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"

namespace aircut::machine {

namespace {

struct FiveBar : BasicModel {
  static constexpr int joints = 3, passives = 2, guards = 2;
  double base = 200;
  std::array<double, 2> inner = {250, 250}, outer = {300, 300};
  Vec3 gauge = Vec3::Zero();

  std::string_view type() const { return "five-bar"; }
  AxisSet axes() const { return axes_of("XYZ"); }
  bool rotary(int joint) const { return joint < 2; }
  std::vector<std::string> passive_names() const { return {"platform_x", "platform_y"}; }
  int passive_count() const { return 2; }
  double motor(std::size_t i) const { return i == 0 ? -base / 2 : base / 2; }

  template <class T>
  std::array<T, joints + passives + guards> solve(const PoseWords<T>& tip, const Vec3& tool,
                                                  int) const {
    using std::acos;
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const Vec3 shift = tool - gauge;
    const T x = tip[0] + T(shift.x()), y = tip[1] + T(shift.y());
    std::array<T, joints + passives + guards> q{};
    std::array<T, 2> ex, ey;
    for (std::size_t i = 0; i < 2; ++i) {
      const double l = inner[i], m = outer[i];
      const T dx = x - T(motor(i)), d = sqrt(square(dx) + square(y));
      const T bend = acos((d + T(l * l - m * m) / d) * T(1 / (2 * l)));
      q[i] = i == 0 ? atan2(y, dx) + bend : atan2(y, dx) - bend;
      ex[i] = T(motor(i)) + T(l) * cos(q[i]);
      ey[i] = T(l) * sin(q[i]);
    }
    q[2] = tip[2] + T(shift.z());
    q[joints] = x;
    q[joints + 1] = y;
    q[joints + passives] = sqrt((ex[1] - ex[0]) * (y - ey[0]) - (ey[1] - ey[0]) * (x - ex[0]));
    q[joints + passives + 1] = sqrt(y);
    return q;
  }

  std::optional<std::string> why_not(const PoseWords<double>& tip, const Vec3& tool, int) const {
    const Vec3 P = Vec3(tip[0], tip[1], tip[2]) + tool - gauge;
    if (!(P.y() > 1e-6))
      return "the point is " + fixed(-P.y(), 3) + " mm behind the line of the motors";
    for (std::size_t i = 0; i < 2; ++i) {
      const double d = std::hypot(P.x() - motor(i), P.y()), l = inner[i], m = outer[i];
      const std::string name = "arm " + std::to_string(i + 1);
      if (d > l + m)
        return name + " is " + fixed(d - l - m, 3) + " mm too short: it reaches " +
               fixed(l + m, 3) + " mm from its motor";
      if (d < std::abs(l - m))
        return name + " can't fold that far: it stays " + fixed(std::abs(l - m), 3) +
               " mm from its motor, this is " + fixed(d, 3);
      const double c = (d * d + l * l - m * m) / (2 * d * l);
      if (!((1 - c) * (1 + c) > 1e-12))
        return name +
               " is stretched or folded, where its motor would need an infinite speed (a "
               "singular pose)";
    }
    const auto q = solve<double>(tip, tool, 0);
    if (q[joints + passives] > 1e-3) return std::nullopt;
    return std::string(
        "the point is not ahead of the line through the elbows, or too near to it "
        "(a singular pose)");
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& q, const Vec3& tool) const {
    std::array<Vec3, 2> e;
    for (std::size_t i = 0; i < 2; ++i) {
      const double angle = q[static_cast<Eigen::Index>(i)];
      e[i] = Vec3(motor(i) + inner[i] * std::cos(angle), inner[i] * std::sin(angle), 0);
    }
    const Vec3 v = e[1] - e[0];
    const double d = v.norm();
    const double a = ((outer[0] - outer[1]) * (outer[0] + outer[1]) + d * d) / (2 * d);
    const double h2 = (outer[0] - a) * (outer[0] + a);
    if (!(d > 1e-9) || !(h2 >= 0))
      return unexpected(ReachError{"the arms don't meet: their elbows are " + fixed(d, 3) +
                                   " mm apart, the outer links reach from " +
                                   fixed(std::abs(outer[0] - outer[1]), 3) + " to " +
                                   fixed(outer[0] + outer[1], 3) + " mm"});
    const Vec3 u = v / d, ahead(-u.y(), u.x(), 0);
    Vec3 P = e[0] + a * u + std::sqrt(h2) * ahead;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 to(P.x() - motor(i), P.y(), 0), arm = e[i] - Vec3(motor(i), 0, 0);
      if ((to.x() * arm.y() - to.y() * arm.x()) * (i == 0 ? 1 : -1) < 0)
        return unexpected(
            ReachError{"the elbow of arm " + std::to_string(i + 1) + " is bent inwards"});
    }
    P.z() = q[2];
    P += gauge - tool;
    AxisValues out;
    for (int i = 0; i < 3; ++i) out[all_axes[static_cast<std::size_t>(i)]] = P[i];
    if (auto error = why_not({P.x(), P.y(), P.z()}, tool, 0))
      return unexpected(ReachError{std::move(*error)});
    return out;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_five_bar(KinematicsInput& input) {
  Parameters p(input);
  p.joints("RRT");
  FiveBar model;
  model.base = p.length("base", model.base);
  for (std::size_t i = 0; i < 2; ++i) {
    model.inner[i] = p.positive("inner" + std::to_string(i + 1), model.inner[i]);
    model.outer[i] = p.positive("outer" + std::to_string(i + 1), model.outer[i]);
  }
  if (model.base < 0) p.fail("base", "'base' must be 0 or more");
  model.gauge = p.point("gauge", Vec3::Zero());
  return p.good() ? make_model(model) : nullptr;
}

}  // namespace aircut::machine
