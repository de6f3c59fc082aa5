// How far a joint goes within a motion, proven, not sampled.
//
// q(t) differs from q(m), m the middle of an interval, by at most the joint's way in it; so
//   max q over the interval ≤ q(m) + travel(interval).
// An interval whose bound is no news is done; any other is halved, down to a nanosecond.
#include <cmath>

#include "motion/motion.h"

namespace aircut::motion {

namespace {
constexpr double shortest_interval = 1e-9;  // s
}  // namespace

std::size_t travel_count(const machine::Machine& machine) {
  return static_cast<std::size_t>(machine.joint_count() + machine.kinematics().passive_count());
}

JointTrack::JointTrack(const JointMotion& motion, machine::JointId joint, double sign)
    : motion_(motion), joint_(index(joint)), sign_(sign), travel_(travel_count(motion.machine())) {}

std::optional<double> JointTrack::value(double t) const {
  const auto q = motion_.at(t);
  if (!q) return std::nullopt;
  return sign_ * (*q)[joint_];
}

std::optional<double> JointTrack::travel(double ta, double tb) {
  if (!motion_.travel_bound(ta, tb, travel_)) return std::nullopt;
  return travel_[static_cast<std::size_t>(joint_)];
}

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

LimitText text_of_passed_limit(const machine::Joint& joint, double sign, double worst) {
  const bool rotary = joint.kind == machine::JointKind::rotary;
  const double scale = rotary ? 180 / M_PI : 1;
  const std::string unit = rotary ? "°" : " mm";
  const double value = sign * worst * scale;
  const double limit = (sign > 0 ? joint.max : joint.min) * scale;
  return {"joint " + joint.name + " passes its " + (sign > 0 ? "upper" : "lower") + " limit by " +
              fixed(std::abs(value - limit), 3) + unit + ": it reaches " + fixed(value, 3) + unit +
              ", the limit is " + fixed(limit, 3) + unit,
          "move the work, the work offset or the start so that " + joint.name + " stays " +
              (sign > 0 ? "at or below " : "at or above ") + fixed(limit, 3) + unit};
}

}  // namespace aircut::motion
