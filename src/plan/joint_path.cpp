// Joints and their derivatives along a path.
//
// Where the kinematics has no analytic rates, q' and q'' come from differences of the inverse along
// the osculating parabola x(h) = p + p' h + p'' h² / 2. It has the path's first two derivatives, so
// q(x(h)) has those of q(s), and it never leaves the piece over a corner. Seven points, central
// (error h⁶):  q'  = Σ c_i (q(+ih) − q(−ih)) / h,        c = 3/4, −3/20, 1/60
//              q'' = (Σ e_i (q(+ih) + q(−ih)) − 49/18 q0) / h²,  e = 3/2, −3/20, 1/90
// h and h / 2 are compared; the step shrinks until they agree, because near a singular pose the
// inverse bends sharply. Where one side is out of reach the step shrinks too: at the very edge of
// the workspace the rates are not finite and that is what is reported.
#include "plan/joint_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace aircut::plan {
namespace {

using machine::JointVector;
using machine::ReachError;
using machine::Target;

struct Rates {
  JointVector dq, ddq;
};

struct Stencil {
  const machine::Kinematics& kinematics;
  const Target& target;
  const AxisValues& d;
  const AxisValues& dd;
  const JointVector& q0;

  tl::expected<JointVector, ReachError> at(double h) const {
    return kinematics.inverse(Target{target.tip + h * d + (h * h / 2) * dd, target.tool_offset},
                              q0);
  }

  tl::expected<Rates, ReachError> differences(double h) const {
    constexpr std::array<double, 3> c = {3.0 / 4, -3.0 / 20, 1.0 / 60};
    constexpr std::array<double, 3> e = {3.0 / 2, -3.0 / 20, 1.0 / 90};
    Rates out{JointVector::Zero(q0.size()), -49.0 / 18 * q0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double step = h * static_cast<double>(i + 1);
      const auto plus = at(step), minus = at(-step);
      if (!plus) return unexpected(plus.error());
      if (!minus) return unexpected(minus.error());
      out.dq += c[i] * (*plus - *minus);
      out.ddq += e[i] * (*plus + *minus);
    }
    out.dq /= h;
    out.ddq /= h * h;
    return out;
  }
};

// Size of a way in mm, with a radian counted as 100 mm: only to choose a step.
double size_of(const AxisValues& way) {
  double sum = 0;
  for (const Axis axis : all_axes) {
    const double value = way[axis] * (is_rotary(axis) ? 100 : 1);
    sum += value * value;
  }
  return std::sqrt(sum);
}

}  // namespace

namespace {

// No error where they are found.
std::optional<ReachError> find_joint_point(const machine::Kinematics& kinematics,
                                           const Target& target, const AxisValues& d_tip,
                                           const AxisValues& dd_tip, const JointVector& near,
                                           JointPoint& out) {
  const auto q = kinematics.inverse(target, near);
  if (!q) return q.error();
  out.q = *q;
  const auto finite = [&out]() -> std::optional<ReachError> {
    if (out.dq.allFinite() && out.ddq.allFinite()) return std::nullopt;
    return ReachError{"the joints would need an infinite speed there (a singular pose)"};
  };
  if (kinematics.rates(target, *q, d_tip, dd_tip, out.dq, out.ddq)) return finite();
  out.dq = out.ddq = JointVector::Zero(q->size());
  const double size = size_of(d_tip);
  if (size == 0 && size_of(dd_tip) == 0) return std::nullopt;
  const Stencil stencil{kinematics, target, d_tip, dd_tip, *q};
  // 0.25 mm is far above the rounding of an inverse (1e-12 mm gives 1e-10 in q'') and far below the
  // size of a machine.
  double h = 0.25 / std::max(size, 1e-9);
  if (const double bend = size_of(dd_tip); bend > 0) h = std::min(h, 0.1 * size / bend + 1e-6);
  tl::expected<Rates, ReachError> coarse = stencil.differences(h);
  tl::expected<Rates, ReachError> best = coarse;
  double best_difference = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 24; ++round) {
    h /= 2;
    const auto fine = stencil.differences(h);
    if (fine && coarse) {
      const double difference =
          (fine->dq - coarse->dq).norm() / (fine->dq.norm() + 1e-300) +
          (fine->ddq - coarse->ddq).norm() / (fine->ddq.norm() + fine->dq.squaredNorm() / 100);
      if (difference < best_difference) {
        best_difference = difference;
        best = fine;
      }
      // Smaller steps only bring rounding once the two agree, or agree less than before.
      if (difference < 1e-6 || (best_difference < 1e-3 && difference > 10 * best_difference)) break;
    } else if (fine && !best) {
      best = fine;
    }
    coarse = fine;
  }
  if (!best)
    out.dq.setConstant(std::numeric_limits<double>::infinity());
  else
    std::tie(out.dq, out.ddq) = std::tie(best->dq, best->ddq);
  return finite();
}

}  // namespace

tl::expected<JointPoint, ReachError> joint_point(const machine::Kinematics& kinematics,
                                                 const Target& target, const AxisValues& d_tip,
                                                 const AxisValues& dd_tip,
                                                 const JointVector& near) {
  JointPoint out;
  if (auto why = find_joint_point(kinematics, target, d_tip, dd_tip, near, out))
    return unexpected(std::move(*why));
  return out;
}

tl::expected<JointVector, ReachError> JointPath::joints(double s, const JointVector& near) const {
  return kinematics_->inverse(Target{evaluate(*path_, s).p, tool_offset_}, near);
}

std::optional<ReachError> JointPath::point(const PathPoint& p, const JointVector& near,
                                           JointPoint& out) const {
  return find_joint_point(*kinematics_, Target{p.p, tool_offset_}, p.d, p.dd, near, out);
}

}  // namespace aircut::plan
