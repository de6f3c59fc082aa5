// Six rods and a platform that moves in all six degrees of freedom:
//
//   hexapod    six struts of changing length from a fixed base
//   hexaglide  six rods of one length on rails
//
// R = Rz(C)·Ry(B)·Rx(A) is the platform's attitude, P its origin, w_i = P + R b_i − o_i; joint
// values as in rods.h. Forward there is no closed form: Newton's method on (P, R) with the rows
//
//   n_iᵀ dP + (R b_i × n_i)ᵀ dω = length_i − |w_i|,        n_i the unit vector along rod i
//
// from the pose `start`; where that does not arrive, the joints are moved there in small parts. The
// sign of the matrix' determinant at the start must stay: beyond its zero lie poses that the
// machine can't get to without falling.
// Joints: q1 … q6. Passive: platform_x, _y, _z, platform_a_angle, _b_angle, _c_angle (couples in
// the order x y z c b a), and the rods' angles when the tree has them.
#include <Eigen/LU>

#include "machine/kinematics/determinant.h"
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"
#include "machine/rotation/rotation.h"

namespace aircut::machine {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct SixRods {
  std::string_view name;
  std::array<Rod, 6> rods;
  Vec3 gauge = Vec3::Zero();  ///< seen from the platform's origin
  Pose start = Pose::Identity();
  bool drawn = false;
  double lever = 1;  ///< mm, makes turns comparable with shifts
  double sign = 1;   ///< of the determinant at the start
};

Mat3 turn_by(const Vec3& w) {
  const double angle = w.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

/// Rows of the platform's motion per rod, and how much each rod's length misses.
void rows_of(const SixRods& g, const Pose& X, const Vector6& q, Matrix6& J, Vector6& miss) {
  for (int i = 0; i < 6; ++i) {
    const Rod& rod = g.rods[static_cast<std::size_t>(i)];
    const Vec3 arm = X.linear() * rod.joint;
    const Vec3 w = X.translation() + arm - rod.base - rod.rail * q[i];
    const double length = w.norm();
    const Vec3 n = w / length;
    J.block<1, 3>(i, 0) = n.transpose();
    J.block<1, 3>(i, 3) = (arm.cross(n) / g.lever).transpose();
    miss[i] = (rod.is_strut() ? q[i] : rod.length) - length;
  }
}

/// Newton from X; false when it does not arrive.
bool newton(const SixRods& g, const Vector6& q, Pose& X) {
  Matrix6 J;
  Vector6 miss;
  bool close = false;
  for (int round = 0; round < 25; ++round) {
    rows_of(g, X, q, J, miss);
    const double error = miss.cwiseAbs().maxCoeff();
    if (!std::isfinite(error)) return false;
    constexpr double there_mm = 1e-6;  // one more step squares it
    if (close && error < there_mm) return true;
    close = error < there_mm;
    Vector6 step = J.partialPivLu().solve(miss);
    const double most = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(most)) return false;
    if (most > g.lever / 2) step *= g.lever / 2 / most;
    X.translation() += step.head<3>();
    X.linear() = turn_by(step.tail<3>() / g.lever) * X.linear();
  }
  return false;
}

struct Rods6 : BasicModel {
  static constexpr int joints = 6, passives = 18;
  SixRods g;

  std::string_view type() const { return g.name; }
  AxisSet axes() const { return axes_of("XYZABC"); }
  std::vector<std::string> passive_names() const {
    std::vector<std::string> names = {"platform_x",       "platform_y",       "platform_z",
                                      "platform_a_angle", "platform_b_angle", "platform_c_angle"};
    if (g.drawn) add_rod_names(6, names);
    return names;
  }
  int passive_count() const { return g.drawn ? 18 : 6; }

  std::optional<Vec3> tool_axis(const AxisValues& tip) const {
    return about_fixed_axes(Vec3(tip[Axis::a], tip[Axis::b], tip[Axis::c])).col(2);
  }

  template <class T>
  std::array<T, joints + passives> solve(const PoseWords<T>& tip, const Vec3& tool, int) const {
    const auto R = Rotation<T>::about_fixed(tip[3], tip[4], tip[5]);
    const Vector<T> P = Vector<T>{tip[0], tip[1], tip[2]} + R(tool - g.gauge);
    std::array<T, joints + passives> q{};
    for (std::size_t i = 0; i < 6; ++i) {
      const Rod& rod = g.rods[i];
      const Vector<T> joint = P + R(rod.joint);
      q[i] = rod_joint(rod, joint - vector_of<T>(rod.base));
      q[joints + i] = i < 3 ? P[i] : tip[i];
      if (g.drawn)
        rod_angles(joint - carriage(rod, q[i]), -1, q[joints + 6 + 2 * i], q[joints + 7 + 2 * i]);
    }
    return q;
  }

  std::optional<std::string> solve_checked(const PoseWords<double>& tip, const Vec3& tool, int,
                                           std::array<double, joints + passives>& out) const {
    const auto R = Rotation<double>::about_fixed(tip[3], tip[4], tip[5]);
    Pose X = Pose::Identity();
    for (int i = 0; i < 3; ++i) X.linear().row(i) = vec3(R.rows[static_cast<std::size_t>(i)]);
    X.translation() = Vec3(tip[0], tip[1], tip[2]) + X.linear() * (tool - g.gauge);
    Vector6 q;
    for (int i = 0; i < 6; ++i) {
      const Rod& rod = g.rods[static_cast<std::size_t>(i)];
      const Vec3 w = X * rod.joint - rod.base;
      if (auto error = why_no_rod(rod, i + 1, w)) return error;
      out[static_cast<std::size_t>(i)] = q[i] = rod_joint(rod, Vector<double>{w.x(), w.y(), w.z()});
    }
    return why_singular(X, q);
  }

  std::optional<std::string> why_singular(const Pose& X, const Vector6& q) const {
    Matrix6 J;
    Vector6 miss;
    rows_of(g, X, q, J, miss);
    constexpr double least = 1e-6;  // rows are unit vectors and arms in levers
    if (determinant(J) * g.sign > least) return std::nullopt;
    return "the rods can't hold the platform there (a singular pose), or it is beyond such a pose";
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& joint_values,
                                               const Vec3& tool) const {
    const Vector6 q = joint_values;
    Pose X = g.start;
    if (!newton(g, q, X) && !in_parts(q, X))
      return unexpected(ReachError{"the rods don't meet at the platform"});
    if (auto error = why_singular(X, q)) return unexpected(ReachError{std::move(*error)});
    for (int i = 0; i < 6; ++i) {
      const Rod& rod = g.rods[static_cast<std::size_t>(i)];
      const double lag = rod.side * (q[i] - rod.rail.dot(X * rod.joint - rod.base));
      if (!rod.is_strut() && lag < 0)
        return unexpected(ReachError{"carriage " + std::to_string(i + 1) + " is " + fixed(-lag, 3) +
                                     " mm on the other side of the platform's joint"});
    }
    const Mat3& R = X.linear();
    const Vec3 p = X.translation() + R * (g.gauge - tool);
    AxisValues tip;
    tip[Axis::x] = p.x();
    tip[Axis::y] = p.y();
    tip[Axis::z] = p.z();
    const Vec3 angles = angles_of({{0, 1, 2}, false}, R).angles;
    for (std::size_t i = 0; i < 3; ++i) tip[all_axes[3 + i]] = angles[static_cast<int>(i)];
    return tip;
  }

  // The joints go from those of the start to q in a straight line.
  bool in_parts(const Vector6& q, Pose& X) const {
    constexpr int parts = 32;
    X = g.start;
    const Vector6 from = start_joints();
    for (int k = 1; k <= parts; ++k)
      if (!newton(g, from + (q - from) * k / parts, X)) return false;
    return true;
  }

  Vector6 start_joints() const {
    Vector6 q;
    for (int i = 0; i < 6; ++i) {
      const Rod& rod = g.rods[static_cast<std::size_t>(i)];
      const Vec3 w = g.start * rod.joint - rod.base;
      q[i] = rod_joint(rod, Vector<double>{w.x(), w.y(), w.z()});
    }
    return q;
  }
};

// Pairs of points on a circle: two each at 0, 120 and 240 degrees, `half` degrees to both sides.
std::vector<Vec3> pairs(double radius, double half) {
  std::vector<Vec3> out;
  for (int i = 0; i < 6; ++i) {
    const double angle = (120.0 * (i / 2) + (i % 2 ? half : -half)) * std::numbers::pi / 180;
    out.push_back(radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return out;
}

std::shared_ptr<const Kinematics> six(KinematicsInput& input, std::string_view name, bool rails) {
  Parameters p(input);
  p.joints("TTTTTT");
  Rods6 model;
  SixRods& g = model.g;
  g.name = name;
  g.drawn = p.drawn("rod");
  g.gauge = p.point("gauge", Vec3::Zero());
  g.start = translation(p.point("start", rails ? Vec3(0, 0, -400) : Vec3(0, 0, -600)));
  const auto base = p.points("base", pairs(400, 15));
  const auto platform = p.points("platform", pairs(160, 45));
  const Vec3 rail = rails ? p.direction("direction", Vec3::UnitZ()) : Vec3::Zero();
  const double length = rails ? p.positive("rod", 500) : 0;
  for (std::size_t i = 0; i < 6; ++i) {
    g.rods[i] = {base[i], rail, length, platform[i], 1};
    g.lever = std::max(g.lever, platform[i].norm());
  }
  if (!p.good()) return nullptr;
  const Vector6 q = model.start_joints();
  Matrix6 J;
  Vector6 miss;
  rows_of(g, g.start, q, J, miss);
  const double at_start = determinant(J);
  if (!(std::abs(at_start) > 1e-6)) {
    p.fail("type", "with the platform at 'start' the rods don't hold it, or don't reach it");
    return nullptr;
  }
  g.sign = at_start > 0 ? 1 : -1;
  return make_model(model);
}

}  // namespace

std::shared_ptr<const Kinematics> read_hexapod(KinematicsInput& input) {
  return six(input, "hexapod", false);
}

std::shared_ptr<const Kinematics> read_hexaglide(KinematicsInput& input) {
  return six(input, "hexaglide", true);
}

}  // namespace aircut::machine
