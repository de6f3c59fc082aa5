// Joint over-travel at any time of a move, proven, not sampled.
//
// q(t) differs from q(m), m the middle of an interval, by at most half-interval travel; so
//   max q over the interval ≤ q(m) + travel(interval).
// If that bound stays inside the range the interval is clear; else it is halved, down to the
// resolution. The same search finds the first time outside, the worst time, and the extremes that
// the report prints.

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/sim.h"

namespace aircut::sim {

namespace {

constexpr double resolution = 1e-6;         // mm or rad: a joint may pass its limit by this much
constexpr double extreme_accuracy = 0.01;   // mm or rad·(π/180): of the reported extremes
constexpr double shortest_interval = 1e-9;  // s

struct Extreme {
  double t = 0;
  double value = 0;  // sign · q
};

// Signed joint value over time within one step: value(t) = sign · q_joint(t).
class JointTrack {
 public:
  JointTrack(const motion::JointMotion& motion, machine::JointId joint, double sign)
      : motion_(motion),
        joint_(index(joint)),
        sign_(sign),
        travel_(motion.machine().tree().size()) {}

  std::optional<double> value(double t) const {
    const auto q = motion_.at(t);
    if (!q) return std::nullopt;
    return sign_ * (*q)[joint_];
  }
  std::optional<double> travel(double ta, double tb) {
    if (!motion_.travel_bound(ta, tb, travel_)) return std::nullopt;
    return travel_[static_cast<std::size_t>(joint_)];
  }

 private:
  const motion::JointMotion& motion_;
  int joint_;
  double sign_;
  std::vector<double> travel_;
};

// Largest value over [ta, tb] to `accuracy`, if it is above `floor`; false when it can't be known.
bool search_maximum(JointTrack& track, double ta, double tb, double accuracy, Extreme& best) {
  const double tm = 0.5 * (ta + tb);
  const auto value = track.value(tm);
  const auto travel = track.travel(ta, tb);
  const bool smallest = tb - ta <= shortest_interval || !(ta < tm && tm < tb);
  if (!value) return false;
  if (*value > best.value) best = {tm, *value};
  if (!travel) {
    if (smallest) return false;
    return search_maximum(track, ta, tm, accuracy, best) &&
           search_maximum(track, tm, tb, accuracy, best);
  }
  if (*value + *travel <= best.value + accuracy || smallest) return true;
  return search_maximum(track, ta, tm, accuracy, best) &&
         search_maximum(track, tm, tb, accuracy, best);
}

// Earliest time in [ta, tb] with a value above `limit` (to the shortest interval), if there is one.
std::optional<double> first_above(JointTrack& track, double ta, double tb, double limit) {
  const double tm = 0.5 * (ta + tb);
  const auto value = track.value(tm);
  const auto travel = track.travel(ta, tb);
  if (value && travel && *value + *travel <= limit) return std::nullopt;
  if (tb - ta <= shortest_interval || !(ta < tm && tm < tb))
    return value && *value > limit ? std::optional(ta) : std::nullopt;
  if (const auto left = first_above(track, ta, tm, limit)) return left;
  return first_above(track, tm, tb, limit);
}

double to_user(double value, bool rotary) { return rotary ? value * 180 / M_PI : value; }

class TravelCheck final : public Check {
 public:
  void start(const Scene& scene, const JointVector& joints, Findings&) override {
    low_.assign(static_cast<std::size_t>(joints.size()), 0);
    high_ = low_;
    names_.clear();
    rotary_.clear();
    for (int j = 0; j < joints.size(); ++j) {
      low_[static_cast<std::size_t>(j)] = high_[static_cast<std::size_t>(j)] = joints[j];
      const machine::Joint& joint = scene.machine().joint(machine::JointId{j});
      names_.push_back(joint.name);
      rotary_.push_back(joint.kind == machine::JointKind::rotary);
    }
  }

  void step(const Step& step, Findings& out) override {
    const double t0 = step.motion.t0(), t1 = step.motion.t1();
    if (std::holds_alternative<plan::Hold>(step.segment.path) || t1 <= t0) {
      if (first_) check_start(step, out);
      first_ = false;
      return;
    }
    first_ = false;
    travel_.assign(step.motion.machine().tree().size(), 0);
    const auto middle = step.motion.at(0.5 * (t0 + t1));
    const bool bounded = step.motion.travel_bound(t0, t1, travel_);
    bool unproven = false;
    for (int j = 0; j < step.motion.machine().joint_count(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const machine::Joint& joint = step.motion.machine().joint(machine::JointId{j});
      const double slack = extreme_accuracy * (rotary_[i] ? M_PI / 180 : 1);
      if (middle && bounded) {
        const double q = (*middle)[j];
        // Nothing new: inside the limits, and inside what was reached before.
        if (q + travel_[i] <= std::min(joint.max, high_[i] + slack) &&
            q - travel_[i] >= std::max(joint.min, low_[i] - slack))
          continue;
      }
      for (const double sign : {1.0, -1.0}) {
        JointTrack track(step.motion, machine::JointId{j}, sign);
        double& reached = sign > 0 ? high_[i] : low_[i];
        Extreme best{t0, sign * reached};
        if (!search_maximum(track, t0, t1, 0.5 * slack, best)) unproven = true;
        reached = sign * best.value;
        report_passed_limit(step, machine::JointId{j}, sign, track, out);
      }
    }
    if (unproven && !step.segment.failure) {
      Finding f = finding_at(Kind::not_checked, step, t0);
      f.message =
          "how far the joints travel within this move can't be bounded, so their limits are not "
          "proven";
      f.t_end = t1;
      f.u_end = 1;
      f.makes_unknown = true;
      out.add(f);
    }
  }

  void finish(Summary& summary) override {
    for (std::size_t j = 0; j < low_.size(); ++j)
      summary.joints.push_back({names_[j], rotary_[j], low_[j], high_[j]});
  }

 private:
  void check_start(const Step& step, Findings& out) {
    for (int j = 0; j < step.motion.machine().joint_count(); ++j)
      for (const double sign : {1.0, -1.0}) {
        JointTrack track(step.motion, machine::JointId{j}, sign);
        report_passed_limit(step, machine::JointId{j}, sign, track, out);
      }
  }

  static void report_passed_limit(const Step& step, machine::JointId id, double sign,
                                  JointTrack& track, Findings& out) {
    const machine::Joint& joint = step.motion.machine().joint(id);
    const double limit = sign > 0 ? joint.max : joint.min;
    if (!std::isfinite(limit)) return;
    const double signed_limit = sign * limit + resolution;
    const double t0 = step.motion.t0(), t1 = step.motion.t1();
    Extreme worst{t0, signed_limit};
    search_maximum(track, t0, t1, resolution, worst);
    if (worst.value <= signed_limit) return;
    const auto first = first_above(track, t0, t1, signed_limit);

    Finding f = finding_at(Kind::overtravel, step, first.value_or(worst.t));
    f.t_worst = worst.t;
    if (const auto state = step.motion.state_at(worst.t)) {
      f.joints_worst = state->q;
      f.tip = state->tip;
      f.feed_actual = state->path_speed;
    }
    // The way back inside, seen from the end.
    f.t_end = t1;
    if (const auto at_end = track.value(t1); at_end && *at_end <= signed_limit)
      f.t_end = last_above(track, worst.t, t1, signed_limit);
    f.u_first = fraction_at(step, f.t_first);
    f.u_end = fraction_at(step, f.t_end);
    const bool rotary = joint.kind == machine::JointKind::rotary;
    f.joint = joint.name;
    f.unit = rotary ? "deg" : "mm";
    f.value = to_user(sign * worst.value, rotary);
    f.limit = to_user(limit, rotary);
    const double excess = std::abs(*f.value - *f.limit);
    const std::string unit = rotary ? "°" : " mm";
    f.message = "joint " + joint.name + " passes its " + (sign > 0 ? "upper" : "lower") +
                " limit by " + fixed(excess, 3) + unit + ": it reaches " + fixed(*f.value, 3) +
                unit + ", the limit is " + fixed(*f.limit, 3) + unit;
    f.remedy = std::string("move the work, the work offset or the start so that ") + joint.name +
               " stays " + (sign > 0 ? "at or below " : "at or above ") + fixed(*f.limit, 3) + unit;
    out.add(f);
  }

  // Latest time in [ta, tb] above the limit: above at ta, not at tb.
  static double last_above(JointTrack& track, double ta, double tb, double limit) {
    while (tb - ta > 1e-7) {
      const double tm = 0.5 * (ta + tb);
      if (!(ta < tm && tm < tb)) break;
      const auto value = track.value(tm);
      (value && *value > limit ? ta : tb) = tm;
    }
    return ta;
  }

  bool first_ = true;
  std::vector<double> low_, high_;
  std::vector<std::string> names_;
  std::vector<bool> rotary_;
  std::vector<double> travel_;
};

}  // namespace

std::unique_ptr<Check> make_travel_check() { return std::make_unique<TravelCheck>(); }

}  // namespace aircut::sim
