// Joint over-travel at any time of a move, proven, not sampled.
//
// The search (motion::search_maximum) bounds a joint over an interval and halves the interval until
// it is clear or out. The same search finds the first time outside, the worst time, and the
// extremes that the report prints.

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/checks/worst_rows.h"

namespace aircut::sim {

using motion::Extreme;
using motion::first_above;
using motion::JointTrack;
using motion::search_maximum;

namespace {

constexpr double resolution = 1e-6;        // mm or rad: a joint may pass its limit by this much
constexpr double extreme_accuracy = 0.01;  // mm or rad·(π/180): of the reported extremes
constexpr double margin_to_limit = 1;      // mm or degrees, overtravel_margin
constexpr double at_rest = 1e-6;           // mm or rad: bounds of joints that rest may be so large
constexpr std::size_t most_margin_rows = 100;

double unit_of(const machine::Joint& joint) {
  return joint.kind == machine::JointKind::rotary ? M_PI / 180 : 1;
}

// How far a joint may come to its limit; joints with hardly any range have no margin.
double margin_of(const machine::Joint& joint) {
  const double margin = margin_to_limit * unit_of(joint);
  return joint.max - joint.min > 4 * margin ? margin : 0;
}

class TravelCheck final : public Check {
 public:
  void start(const Scene& scene, const JointVector& joints, Findings&) override {
    low_.assign(static_cast<std::size_t>(joints.size()), 0);
    high_ = low_;
    names_.clear();
    rotary_.clear();
    near_.clear();
    for (int j = 0; j < joints.size(); ++j) {
      low_[static_cast<std::size_t>(j)] = high_[static_cast<std::size_t>(j)] = joints[j];
      const machine::Joint& joint = scene.machine().joint(machine::JointId{j});
      names_.push_back(joint.name);
      rotary_.push_back(joint.kind == machine::JointKind::rotary);
      near_.push_back(
          {joints[j]<joint.min + margin_of(joint), joints[j]> joint.max - margin_of(joint)});
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
        const bool rests = travel_[i] <= at_rest;
        const bool far_off = q + travel_[i] <= joint.max - margin_of(joint) &&
                             q - travel_[i] >= joint.min + margin_of(joint);
        if (!rests && far_off) near_[i] = {false, false};
        if (!rests && !far_off) look_at_margin(step, machine::JointId{j});
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

  void finish(Summary& summary, Findings& out) override {
    margin_rows_.hand_over("places", out);
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

  // A joint that comes into the margin before its limit, and does not pass the limit.
  void look_at_margin(const Step& step, machine::JointId id) {
    const machine::Joint& joint = step.motion.machine().joint(id);
    const double unit = unit_of(joint);
    const double t0 = step.motion.t0(), t1 = step.motion.t1();
    for (const double sign : {1.0, -1.0}) {
      bool& near = near_[static_cast<std::size_t>(machine::index(id))][sign > 0 ? 1 : 0];
      const double limit = sign > 0 ? joint.max : joint.min;
      // Many machines have their home at the end of an axis, and every retract goes there.
      const bool home = sign * (limit - joint.home) < margin_of(joint);
      if (!std::isfinite(limit) || margin_of(joint) == 0 || home) continue;
      JointTrack track(step.motion, id, sign);
      const double begins = sign * limit - margin_of(joint) + resolution;
      Extreme most{t0, begins};
      search_maximum(track, t0, t1, resolution, most);
      const auto at_end = track.value(t1);
      const bool was_near = near;
      near = at_end && *at_end > begins;
      if (was_near || most.value <= begins || most.value > sign * limit + resolution) continue;
      const double left = sign * limit - most.value;
      if (!margin_rows_.wants(-left / unit)) continue;
      const auto first = first_above(track, t0, t1, begins);
      Finding f = finding_at(Kind::overtravel_margin, step, first.value_or(most.t));
      f.t_worst = most.t;
      f.t_end = t1;
      if (const auto joints = step.motion.at(most.t)) f.joints_worst = *joints;
      f.u_first = fraction_at(step, f.t_first);
      f.u_end = fraction_at(step, f.t_end);
      f.joint = joint.name;
      f.unit = joint.kind == machine::JointKind::rotary ? "deg" : "mm";
      f.value = sign * most.value / unit;
      f.limit = limit / unit;
      f.message = "`" + joint.name + "` comes to " + fixed(std::max(0.0, left / unit), 3) +
                  (f.unit == "mm" ? " mm" : "°") + " of its limit " + shortest(*f.limit);
      f.remedy = "move the work offset, or clamp the part elsewhere";
      margin_rows_.add(-left / unit, std::move(f));
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
    const double scale = joint.kind == machine::JointKind::rotary ? 180 / M_PI : 1;
    f.joint = joint.name;
    f.unit = joint.kind == machine::JointKind::rotary ? "deg" : "mm";
    f.value = sign * worst.value * scale;
    f.limit = limit * scale;
    const motion::LimitText text = motion::text_of_passed_limit(joint, sign, worst.value);
    f.message = text.message;
    f.remedy = text.remedy;
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
  std::vector<std::array<bool, 2>>
      near_;  ///< each joint is in the margin of its lower, upper limit
  WorstRows margin_rows_{most_margin_rows};
};

}  // namespace

std::unique_ptr<Check> make_travel_check() { return std::make_unique<TravelCheck>(); }

}  // namespace aircut::sim
