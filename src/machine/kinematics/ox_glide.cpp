// ox-glide: two sliders on parallel guides carry a platform by one rod each; a third slider moves
// the whole plane along Y. kinematics.md (b).
//
//        z ^      guide 2, z = +d   ========[s2]==================        crossed form:
//          |                                  \ l2                        slider 1 on the right of
//          +--> x guide 1, z = −d   ===========\=======[s1]=======        the platform, slider 2 on
//                                               \     / l1                the left;
//                                                \   /                    extended form: the other
//                                        p1: o----P----o :p2              way round
//
// With the reduced slider positions S1 = s1 + p1 and S2 = s2 − p2 both rods end in P = (x, z):
//
//   l1² = (x − S1)² + (z + d)²        l2² = (x − S2)² + (z − d)²
//
// u1 = −(z + d) and u2 = d − z are the depths of P below the guides, w = √(l² − u²) the horizontal
// reach of a rod. Crossed: S1 = x + w1, S2 = x − w2; extended: S1 = x − w1, S2 = x + w2. The form
// is a parameter of the machine: no program can change it (b.4).
#include <algorithm>
#include <cmath>

#include "machine/kinematics/kinematics_table.h"

namespace aircut::machine {

namespace {

// Reach of a rod that is `depth` high: w(u) = √(l² − u²), and its derivatives by u. Nothing when
// the rod does not reach.
struct Reach {
  double w;
  double dw;   // w'  = −u / w
  double ddw;  // w'' = −l² / w³
};

Reach reach(double l, double u) {
  // The product keeps its precision near u = l, where the difference of squares loses it.
  const double w = std::sqrt((l - u) * (l + u));
  return {w, -u / w, -l * l / (w * w * w)};
}

struct Point {
  double x, z;
};

class OxGlideKinematics final : public Kinematics {
 public:
  explicit OxGlideKinematics(const OxGlide& p)
      : p_(p), side_(p.form == OxGlide::Form::crossed ? 1.0 : -1.0) {}

  std::string_view type() const override { return "ox-glide"; }
  AxisSet axes() const override {
    AxisSet set;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) set.add(axis);
    return set;
  }
  int joint_count() const override { return 3; }
  std::vector<std::string> passive_names() const override {
    return {"rod1_angle", "rod2_angle", "platform_x", "platform_z"};
  }
  int passive_count() const override { return 4; }

  tl::expected<JointVector, ReachError> inverse(const Target& target,
                                                const JointVector&) const override {
    const Point P = platform(target.tip, target.tool_offset);
    if (const auto error = why_not(target, P.z)) return unexpected(ReachError{*error});
    JointVector joints(3);
    joints[0] = P.x - p_.p1 + side_ * reach(p_.l1, depth1(P.z)).w;
    joints[1] = P.x + p_.p2 - side_ * reach(p_.l2, depth2(P.z)).w;
    joints[2] = target.tip[Axis::y] + target.tool_offset[Axis::y] - p_.offset.y();
    return joints;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    const Crossing c = crossing(joints);
    if (!(c.h2 >= 0))
      return unexpected(ReachError{"the rods don't meet: sliders at " + shortest(joints[0]) +
                                   " and " + shortest(joints[1]) + " are too far apart"});
    if (!in_form(joints, c.P)) {
      const bool crossed = p_.form == OxGlide::Form::crossed;
      return unexpected(ReachError{"sliders at " + shortest(joints[0]) + " and " +
                                   shortest(joints[1]) + " are not in the " +
                                   (crossed ? "crossed" : "extended") + " form"});
    }
    AxisValues tip;
    tip[Axis::x] = c.P.x + p_.offset.x() - tool_offset[Axis::x];
    tip[Axis::y] = joints[2] + p_.offset.y() - tool_offset[Axis::y];
    tip[Axis::z] = c.P.z + p_.offset.z() - tool_offset[Axis::z];
    return tip;
  }

  // Rod angles about +Y, zero when the rod hangs straight down from its slider: the rod's direction
  // is Ry(φ)·(0, 0, −1) = (−sin φ, 0, −cos φ). Where the rods don't meet they are drawn pointing at
  // each other; forward() tells that this is no position of the machine.
  void passive(const JointVector& joints, std::span<double> out) const override {
    const Point P = crossing(joints).P;
    out[0] = std::atan2(joints[0] + p_.p1 - P.x, depth1(P.z));
    out[1] = std::atan2(joints[1] - p_.p2 - P.x, depth2(P.z));
    out[2] = P.x;
    out[3] = P.z;
  }

  // S = x ± w(u), u = const − z, so Ṡ = ẋ ∓ w'·ż and S̈ = ẍ ± (w''·ż² − w'·z̈).
  bool rates(const Target& target, const JointVector&, const AxisValues& d_tip,
             const AxisValues& dd_tip, JointVector& dq, JointVector& ddq) const override {
    const Point P = platform(target.tip, target.tool_offset);
    if (why_not(target, P.z)) return false;
    const Reach r1 = reach(p_.l1, depth1(P.z));
    const Reach r2 = reach(p_.l2, depth2(P.z));
    constexpr double singular_mm = 1e-6;  // rod vertical: the slider's speed has no limit
    if (r1.w < singular_mm || r2.w < singular_mm) return false;
    const double vx = d_tip[Axis::x], vz = d_tip[Axis::z];
    const double ax = dd_tip[Axis::x], az = dd_tip[Axis::z];
    dq.resize(3);
    ddq.resize(3);
    dq << vx - side_ * r1.dw * vz, vx + side_ * r2.dw * vz, d_tip[Axis::y];
    ddq << ax + side_ * (r1.ddw * vz * vz - r1.dw * az),
        ax - side_ * (r2.ddw * vz * vz - r2.dw * az), dd_tip[Axis::y];
    return true;
  }

  // While P moves in a box by ways Tx, Tz (integrals of |ẋ|, |ż|), slider i travels
  //   ∫|ẋ ∓ w'(u)·ż| ≤ Tx + max|w'| · Tz,
  // and rod i, whose angle is φ = ±acos(u/l), a function of z alone, turns by
  //   ∫|dφ/du|·|ż| ≤ max(1/w) · Tz.
  // |w'| = u/w and 1/w both grow with u on 0 ≤ u < l, so each has its largest value at the lowest z
  // of the box. The whole box must be below the guides (u > 0 at its highest z) and above the depth
  // where a rod is vertical (u < l at its lowest z).
  bool travel_bound(const TipInterval& tip, std::span<double> travel) const override {
    const Point low = platform(tip.low, tip.tool_offset);
    const Point high = platform(tip.high, tip.tool_offset);
    if (!(depth1(high.z) > 0 && depth1(low.z) < p_.l1)) return false;
    if (!(depth2(high.z) > 0 && depth2(low.z) < p_.l2)) return false;
    const Reach r1 = reach(p_.l1, depth1(low.z));
    const Reach r2 = reach(p_.l2, depth2(low.z));
    constexpr double rounding = 1 + 1e-9;  // far above that of the dozen operations here
    const double tx = tip.travel[Axis::x] * rounding;
    const double tz = tip.travel[Axis::z] * rounding;
    travel[0] = tx - r1.dw * tz;
    travel[1] = tx - r2.dw * tz;
    travel[2] = tip.travel[Axis::y];
    travel[3] = tz / r1.w;
    travel[4] = tz / r2.w;
    travel[5] = tx;
    travel[6] = tz;
    return std::isfinite(travel[0]) && std::isfinite(travel[1]);
  }

 private:
  double depth1(double z) const { return -(z + p_.d); }
  double depth2(double z) const { return p_.d - z; }

  Point platform(const AxisValues& tip, const AxisValues& tool_offset) const {
    return {tip[Axis::x] + tool_offset[Axis::x] - p_.offset.x(),
            tip[Axis::z] + tool_offset[Axis::z] - p_.offset.z()};
  }

  // Why a height has no solution, in terms of the tip.
  std::optional<std::string> why_not(const Target& target, double z) const {
    const double tip_z = target.tip[Axis::z];
    const double up = tip_z - z;  // from the platform point to the tip
    const auto rod = [&](int number, double l, double depth, double lowest) {
      return "rod " + std::to_string(number) + " is " + fixed(depth - l, 3) +
             " mm too short for Z " + fixed(tip_z, 3) + "; it reaches down to Z " +
             fixed(lowest + up, 3);
    };
    if (!(depth1(z) > 0))
      return "Z " + fixed(tip_z, 3) + " lifts the platform to the guides; it must stay below Z " +
             fixed(-p_.d + up, 3);
    // Of two rods that don't reach, name the one that misses more.
    const double miss1 = depth1(z) - p_.l1, miss2 = depth2(z) - p_.l2;
    if (miss2 > 0 && miss2 >= miss1) return rod(2, p_.l2, depth2(z), p_.d - p_.l2);
    if (miss1 > 0) return rod(1, p_.l1, depth1(z), -p_.d - p_.l1);
    return std::nullopt;
  }

  struct Crossing {
    Point P;    // the lower crossing; where the circles don't meet, the nearest point between them
    double h2;  // square of half the distance of the two crossings, negative: they don't meet
  };

  // Circles about (S1, −d) and (S2, +d) with radii l1, l2. P lies below the line of the sliders in
  // both forms (kinematics.md b.3), so the wanted crossing is the lower one.
  Crossing crossing(const JointVector& joints) const {
    const double s1 = joints[0] + p_.p1, s2 = joints[1] - p_.p2;
    const double vx = s2 - s1, vz = 2 * p_.d;
    const double length = std::hypot(vx, vz);  // ≥ 2d > 0
    const double ux = vx / length, uz = vz / length;
    const double a = (p_.l1 * p_.l1 - p_.l2 * p_.l2 + length * length) / (2 * length);
    const double h2 = (p_.l1 - a) * (p_.l1 + a);
    const double h = std::sqrt(std::max(0.0, h2));
    // Normal n = (−uz, ux): the lower point is on the side where its z component is negative.
    const double lower = ux > 0 ? -h : h;
    return {{s1 + a * ux - lower * uz, -p_.d + a * uz + lower * ux}, h2};
  }

  bool in_form(const JointVector& joints, const Point& P) const {
    const double right = side_ * (joints[0] + p_.p1 - P.x);
    const double left = side_ * (P.x - (joints[1] - p_.p2));
    return P.z < -p_.d && right >= 0 && left >= 0;
  }

  OxGlide p_;
  double side_;  // +1: slider 1 on the right of P (crossed), −1: on the left (extended)
};

}  // namespace

std::shared_ptr<const Kinematics> make_ox_glide(const OxGlide& parameters) {
  return std::make_shared<OxGlideKinematics>(parameters);
}

std::shared_ptr<const Kinematics> read_ox_glide(KinematicsInput& input) {
  config::Table& table = input.table;
  OxGlide p;
  if (!table.has("form"))
    table.error("form",
                "'form' is missing: \"crossed\" or \"extended\", the way the machine is set up");
  const std::string form = table.choice("form", {"crossed", "extended"}, "crossed");
  p.form = form == "crossed" ? OxGlide::Form::crossed : OxGlide::Form::extended;
  bool good = table.has("form");
  const auto read = [&](const std::string& key, double& value, bool positive) {
    if (!table.has(key))
      table.error(key, "'" + key + "' is missing: a length of the glide (docs/machine-package.md)");
    value = length(table, key, value, input.unit_mm);
    if (positive && value <= 0) table.error(key, "'" + key + "' must be more than 0");
    good = good && table.has(key) && (!positive || value > 0);
  };
  read("l1", p.l1, true);
  read("l2", p.l2, true);
  read("p1", p.p1, false);
  read("p2", p.p2, false);
  read("d", p.d, true);
  p.offset = point(table, "offset", Vec3::Zero(), input.unit_mm);
  if (input.driven.size() != 3) {
    table.error("type",
                "ox-glide has 3 driven axes, in this order: slider 1, slider 2, the slide "
                "along Y; this machine has " +
                    std::to_string(input.driven.size()));
    good = false;
  }
  for (const Joint& joint : input.driven) {
    if (joint.kind == JointKind::linear) continue;
    table.error("type", "the driven axes of ox-glide are linear, '" + joint.name + "' is rotary");
    good = false;
  }
  return good ? make_ox_glide(p) : nullptr;
}

}  // namespace aircut::machine
