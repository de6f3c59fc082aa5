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

#include "plan/law_writer.h"

namespace aircut::plan {
namespace {

constexpr double share = 0.65;

double least(const machine::JointVector& limits, const machine::JointVector& dq) {
  return 1 / dq.cwiseQuotient(limits).cwiseAbs().maxCoeff();
}

double largest(const machine::JointVector& x) { return x.cwiseAbs().maxCoeff(); }

// Gathers the load from place to place.
class Collector {
 public:
  Collector(double feed, const JointLimits& limits, double step)
      : feed_(feed), limits_(limits), has_jerk_(limits.has_jerk()), step_(step) {}

  /// `tip`: the tip's speed per path speed.
  void add(double tip, const machine::JointVector& dq, const machine::JointVector& ddq,
           bool at_end) {
    const double speed = std::min(feed_ / tip, least(limits_.v, dq));
    out_.acceleration =
        std::max(out_.acceleration, speed * speed * largest(ddq.cwiseQuotient(limits_.a)));
    if (!first_ && has_jerk_) {
      const double third = largest((ddq - before_).cwiseQuotient(limits_.j)) / step_;
      out_.jerk = std::max(out_.jerk, speed * speed * speed * third);
    }
    if (at_end && has_jerk_) {
      const StraightLimits here{speed, least(limits_.a, dq), least(limits_.j, dq)};
      out_.along =
          first_ ? here
                 : StraightLimits{std::min(out_.along.v, here.v), std::min(out_.along.a, here.a),
                                  std::min(out_.along.j, here.j)};
    }
    out_.speed = first_ ? speed : std::min(out_.speed, speed);
    first_ = false;
    if (has_jerk_) before_ = ddq;
  }
  CornerLoad finish() {
    out_.known = true;
    return out_;
  }

 private:
  CornerLoad out_;
  double feed_;
  const JointLimits& limits_;
  bool has_jerk_;
  double step_;
  bool first_ = true;
  machine::JointVector before_;
};

}  // namespace

double CornerLoad::demand() const { return known ? std::max(acceleration, std::sqrt(jerk)) : 1; }

CornerLoad load_of(const machine::Kinematics& kinematics, const Blend& blend, double feed,
                   const AxisValues& tool_offset, const JointLimits& limits,
                   const machine::JointVector& near) {
  constexpr int samples = 8;
  Collector collector(feed, limits, blend.length / samples);
  machine::JointVector guess = near;
  for (int k = 0; k <= samples; ++k) {
    const PathPoint p = evaluate(blend, blend.length * k / samples);
    const auto joint = joint_point(kinematics, {p.p, tool_offset}, p.d, p.dd, guess);
    if (!joint) return {};
    guess = joint->q;
    collector.add(metric_length(Metric::xyz, p.d), joint->dq, joint->ddq, k == 0 || k == samples);
  }
  return collector.finish();
}

CornerLoad load_of_lines(const CornerRates& rates, double cut, const machine::JointVector& in,
                         const machine::JointVector& out, double turn_cosine, double feed,
                         const JointLimits& limits) {
  constexpr std::size_t stride = 2;  // every second place is enough
  const std::size_t last = rates.at.size() - 1;
  Collector collector(feed, limits, stride * cut * rates.length / static_cast<double>(last));
  machine::JointVector dq, ddq;
  for (std::size_t k = 0; k <= last; k += stride) {
    const auto& [d, dd] = rates.at[k];
    dq = d[0] * in + d[1] * out;
    ddq = (dd[0] / cut) * in + (dd[1] / cut) * out;
    collector.add(std::sqrt(d[0] * d[0] + d[1] * d[1] + 2 * d[0] * d[1] * turn_cosine), dq, ddq,
                  k == 0 || k == last);
  }
  return collector.finish();
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
