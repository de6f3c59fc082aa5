// pentapod: five struts of changing length hold a spindle by rings that turn about its axis.
//
//   o a_i (fixed)          Seen from the spindle, w = Rᵀ (a_i − p), R = Ry(B)·Rx(A): the ring's
//    \                     joint is in the half plane of the axis and w, so
//     \ q_i      ║           q_i = hypot(w_z − ζ_i, hypot(w_x, w_y) − ρ_i)
//      o--ρ_i----║ ring at height ζ_i
//                ║         p is the gauge point; the roll about the spindle is free.
//                V p
//
// Forward by Newton's method with damping from the pose `start`, with derivatives of the closed
// form. Joints: q1 … q5. Passive: platform_x, _y, _z, platform_a_angle, platform_b_angle (couples
// in the order x y z b a).
#include <Eigen/LU>

#include "machine/kinematics/determinant.h"
#include "machine/kinematics/parameters.h"
#include "machine/kinematics/rods.h"

namespace aircut::machine {

namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;

struct Pentapod : BasicModel {
  static constexpr int joints = 5, passives = 5;
  std::array<Vec3, 5> base;
  std::array<double, 5> ring{}, height{};  ///< ρ, ζ
  Vec3 start = Vec3::Zero();
  double sign = 1;  ///< of the determinant at the start

  std::string_view type() const { return "pentapod"; }
  AxisSet axes() const { return axes_of("XYZAB"); }
  std::vector<std::string> passive_names() const {
    return {"platform_x", "platform_y", "platform_z", "platform_a_angle", "platform_b_angle"};
  }
  int passive_count() const { return passives; }
  std::optional<std::string> wrong_offset(const AxisValues& offset) const {
    return wrong_offset_but_z(offset);
  }
  std::optional<Vec3> tool_axis(const AxisValues& tip) const {
    const double a = tip[Axis::a], b = tip[Axis::b];
    return Vec3(std::sin(b) * std::cos(a), -std::sin(a), std::cos(b) * std::cos(a));
  }

  template <class T>
  std::array<T, joints + passives> solve(const PoseWords<T>& tip, const Vec3& tool, int) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T ca = cos(tip[3]), sa = sin(tip[3]), cb = cos(tip[4]), sb = sin(tip[4]);
    const Vector<T> k = {sb * ca, -sa, cb * ca};
    const T length(tool.z());
    const Vector<T> p = {tip[0] + length * k[0], tip[1] + length * k[1], tip[2] + length * k[2]};
    std::array<T, joints + passives> q{};
    for (std::size_t i = 0; i < 5; ++i) {
      const Vector<T> d = vector_of<T>(base[i]) - p;
      // Rx(−A)·Ry(−B)·d.
      const T x = cb * d[0] - sb * d[2], z0 = sb * d[0] + cb * d[2];
      const T y = ca * d[1] + sa * z0, z = ca * z0 - sa * d[1];
      q[i] = sqrt(square(z - T(height[i])) + square(sqrt(square(x) + square(y)) - T(ring[i])));
      q[joints + i] = i < 3 ? p[i] : tip[i];
    }
    return q;
  }

  // Derivatives of the struts by x y z (mm) and A B (in units of 1 rad · lever). With the tool's
  // length L, w = Rᵀ(a − tip) − (0, 0, L), and g the strut's direction seen from the spindle:
  // dq = g·dw with dw = −Rᵀ dtip, and for the angles with w' = w + (0, 0, L)
  // ∂w/∂A = (0, w'_z, −w'_y), ∂w/∂B = (−ζ', sA w'_x, cA w'_x), ζ' = sB d_x + cB d_z of d = a − tip.
  static constexpr double lever = 100;
  void rows_of(const PoseWords<double>& tip, const Vec3& tool, Matrix5& J, Vector5& q) const {
    const double ca = std::cos(tip[3]), sa = std::sin(tip[3]);
    const double cb = std::cos(tip[4]), sb = std::sin(tip[4]);
    for (int i = 0; i < 5; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vec3 d = base[at] - Vec3(tip[0], tip[1], tip[2]);
      const double x = cb * d.x() - sb * d.z(), turned = sb * d.x() + cb * d.z();
      const double y = ca * d.y() + sa * turned, z = ca * turned - sa * d.y();
      const double out = std::sqrt(x * x + y * y), beyond = out - ring[at];
      const double up = z - tool.z() - height[at];
      q[i] = std::sqrt(up * up + beyond * beyond);
      const double along = beyond / (q[i] * out);
      const Vec3 g(along * x, along * y, up / q[i]);
      const double level = sa * g.y() + ca * g.z();  // of Rx(A)·g, its z
      J(i, 0) = -(cb * g.x() + sb * level);
      J(i, 1) = sa * g.z() - ca * g.y();
      J(i, 2) = sb * g.x() - cb * level;
      J(i, 3) = (g.y() * z - g.z() * y) / lever;
      J(i, 4) = (x * level - turned * g.x()) / lever;
    }
  }

  std::optional<std::string> solve_checked(const PoseWords<double>& tip, const Vec3& tool, int,
                                           std::array<double, joints + passives>& out) const {
    Matrix5 J;
    Vector5 q;
    rows_of(tip, tool, J, q);
    for (int i = 0; i < 5; ++i) {
      if (!(q[i] > 1e-6)) return "strut " + std::to_string(i + 1) + " would have no length";
      out[static_cast<std::size_t>(i)] = q[i];
    }
    constexpr double least = 1e-6;
    if (J.allFinite() && determinant(J) * sign > least) return std::nullopt;
    return std::string(
        "the struts can't hold the spindle there (a singular pose), or it is beyond such a pose");
  }

  bool newton(const Vector5& wanted, PoseWords<double>& tip, const Vec3& tool) const {
    Matrix5 J;
    Vector5 q;
    double damping = 1e-9, best = std::numeric_limits<double>::infinity();
    PoseWords<double> at = tip;
    bool close = false;
    for (int round = 0; round < 60; ++round) {
      rows_of(at, tool, J, q);
      const double error = (wanted - q).cwiseAbs().maxCoeff();
      constexpr double there_mm = 1e-6;  // one more step squares it
      if (close && error <= there_mm) {
        tip = at;
        return true;
      }
      if (std::isfinite(error) && error < best) {
        best = error;
        tip = at;
        damping = std::max(damping * 0.2, 1e-12);
      } else {
        damping *= 100;
        at = tip;
        rows_of(at, tool, J, q);
      }
      close = best <= there_mm;
      const Matrix5 N = J.transpose() * J + damping * Matrix5::Identity();
      const Vector5 gradient = J.transpose() * (wanted - q);
      const Vector5 step = damping > 1e-11 ? Vector5(N.partialPivLu().solve(gradient))
                                           : Vector5(J.partialPivLu().solve(wanted - q));
      if (!step.allFinite()) return false;
      for (std::size_t i = 0; i < 5; ++i)
        at[i] += step[static_cast<Eigen::Index>(i)] / (i < 3 ? 1 : lever);
    }
    return false;
  }

  tl::expected<AxisValues, ReachError> forward(const JointVector& values, const Vec3& tool) const {
    const Vector5 q = values;
    const PoseWords<double> from = {start.x(), start.y(), start.z(), 0, 0, 0};
    PoseWords<double> tip = from;
    if (!newton(q, tip, Vec3::Zero()) && !in_parts(q, from, tip))
      return unexpected(ReachError{"the struts don't meet at the spindle"});
    std::array<double, joints + passives> back;
    if (auto error = solve_checked(tip, Vec3::Zero(), 0, back))
      return unexpected(ReachError{*error});
    AxisValues out;
    for (std::size_t i = 0; i < 5; ++i) out[all_axes[i]] = tip[i];
    const Vec3 k = *tool_axis(out) * tool.z();
    for (std::size_t i = 0; i < 3; ++i) out[all_axes[i]] -= k[static_cast<int>(i)];
    return out;
  }

  // The struts go from those of the start to q in a straight line.
  bool in_parts(const Vector5& q, const PoseWords<double>& from, PoseWords<double>& tip) const {
    constexpr int parts = 32;
    Matrix5 J;
    Vector5 first;
    rows_of(from, Vec3::Zero(), J, first);
    tip = from;
    for (int k = 1; k <= parts; ++k)
      if (!newton(first + (q - first) * k / parts, tip, Vec3::Zero())) return false;
    return true;
  }
};

}  // namespace

std::shared_ptr<const Kinematics> read_pentapod(KinematicsInput& input) {
  Parameters p(input);
  p.joints("TTTTT");
  Pentapod model;
  std::vector<Vec3> anchors;
  std::vector<double> rings = {80, 80, 80, 80, 80}, heights = {400, 100, 400, 100, 400};
  const std::array<double, 5> z = {1000, 300, 1000, 300, 1000};
  for (std::size_t i = 0; i < 5; ++i) {
    const double azimuth = (18 + 72.0 * static_cast<double>(i)) * std::numbers::pi / 180;
    anchors.push_back(Vec3(900 * std::cos(azimuth), 900 * std::sin(azimuth), z[i]));
  }
  anchors = p.points("base", anchors);
  const auto five = [&](const char* key, std::vector<double>& values) {
    if (const auto given = input.table.numbers(key, 5))
      for (std::size_t i = 0; i < 5; ++i) values[i] = (*given)[i] * input.unit_mm;
  };
  five("ring", rings);
  five("height", heights);
  for (std::size_t i = 0; i < 5; ++i) {
    model.base[i] = anchors[i];
    model.ring[i] = rings[i];
    model.height[i] = heights[i];
    if (!(rings[i] >= 0 && rings[i] < 1e6 && std::abs(heights[i]) < 1e6))
      p.fail(rings[i] >= 0 && rings[i] < 1e6 ? "height" : "ring",
             "rings have radii from 0 and heights up to 1 km");
  }
  model.start = p.point("start", Vec3::Zero());
  if (!p.good()) return nullptr;
  Matrix5 J;
  Vector5 q;
  model.rows_of({model.start.x(), model.start.y(), model.start.z(), 0, 0, 0}, Vec3::Zero(), J, q);
  const double at_start = determinant(J);
  if (!J.allFinite() || !(std::abs(at_start) > 1e-6)) {
    p.fail("type", "with the spindle upright at 'start' the struts don't hold it");
    return nullptr;
  }
  model.sign = at_start > 0 ? 1 : -1;
  return make_model(model);
}

}  // namespace aircut::machine
