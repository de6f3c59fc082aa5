// Blend or stop? Under a jerk limit a small blend can be slower than a stop at the corner. With v_b
// the speed at which the blend can be passed, the ride slows from v to v_b and back; compared over
// the same way with a ride that slows to rest:
//
//   blend  2 t(v, v_b) + share · length / v_b      way 2 d(v, v_b) + 2 cut
//   stop   2 t(v, 0)                               way 2 d(v, 0)
//
// where t is the time of a change of speed with rest of acceleration at both ends, d its way. v_b
// counts in the middle only: the ends are passed faster; `share` stands for that. It was set by the
// numeric optima of right-angled corners. A wrong guess near the border costs a few milliseconds.
#include "plan/corner_load.h"

#include <algorithm>
#include <cmath>

namespace aircut::plan {
namespace {

constexpr double share = 0.65;

double least(const machine::JointVector& limits, const machine::JointVector& dq) {
  return 1 / dq.cwiseQuotient(limits).cwiseAbs().maxCoeff();
}

double change_time(double change, const StraightLimits& limits) {
  return change >= limits.a * limits.a / limits.j ? change / limits.a + limits.a / limits.j
                                                  : 2 * std::sqrt(change / limits.j);
}

}  // namespace

double CornerLoad::demand() const { return known ? std::max(acceleration, std::sqrt(jerk)) : 1; }

CornerLoad load_of(const machine::Kinematics& kinematics, const Blend& blend, double feed,
                   const AxisValues& tool_offset, const JointLimits& limits,
                   const machine::JointVector& near) {
  CornerLoad out;
  machine::JointVector guess = near, ddq_before;
  constexpr int samples = 8;
  const double step = blend.length / samples;
  for (int k = 0; k <= samples; ++k) {
    const PathPoint p = evaluate(blend, blend.length * k / samples);
    const auto joint = joint_point(kinematics, {p.p, tool_offset}, p.d, p.dd, guess);
    if (!joint) return {};
    guess = joint->q;
    const double tip = metric_length(Metric::xyz, p.d);
    const double speed = std::min(feed / tip, least(limits.v, joint->dq));
    const auto largest = [](const machine::JointVector& x) { return x.cwiseAbs().maxCoeff(); };
    out.acceleration =
        std::max(out.acceleration, speed * speed * largest(joint->ddq.cwiseQuotient(limits.a)));
    if (k > 0 && limits.has_jerk()) {
      const double third = largest((joint->ddq - ddq_before).cwiseQuotient(limits.j)) / step;
      out.jerk = std::max(out.jerk, speed * speed * speed * third);
    }
    if (k == 0 || k == samples) {
      const StraightLimits here{speed, least(limits.a, joint->dq), least(limits.j, joint->dq)};
      out.along = k == 0
                      ? here
                      : StraightLimits{std::min(out.along.v, here.v), std::min(out.along.a, here.a),
                                       std::min(out.along.j, here.j)};
    }
    out.speed = k == 0 ? speed : std::min(out.speed, speed);
    ddq_before = joint->ddq;
  }
  out.known = true;
  return out;
}

bool stop_is_faster(const CornerLoad& load, const Blend& blend, double cut, double shorter) {
  if (!load.known || std::isinf(load.along.j)) return false;
  // A way that could not be made even in speed (nearly a cusp) is run too unevenly.
  if (runs_along_u(blend)) return true;
  // The speed that a side reaches if it starts and ends at rest.
  double v = 0;
  for (const ProfileKnot& knot : s_curve(shorter, load.along).knots) v = std::max(v, knot.v);
  v = std::min(v, load.speed);
  const double slow =
      load.speed / std::max({std::sqrt(load.acceleration), std::cbrt(load.jerk), 1.0});
  if (v <= slow) return false;
  const double t_blend = change_time(v - slow, load.along), t_stop = change_time(v, load.along);
  const double with_blend = 2 * t_blend + share * blend.length / slow;
  const double more_way = (v + slow) * t_blend + 2 * cut - v * t_stop;
  return 2 * t_stop + more_way / v < with_blend;
}

}  // namespace aircut::plan
