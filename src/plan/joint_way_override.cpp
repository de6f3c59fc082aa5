// Overrides and holds of rapids that are straight in the joints, or doglegs. The way in the joints
// stays; what changes are the laws: the one that all joints share, or that of each joint.
//
// From an event on a law has another top speed. It takes its acceleration back, goes over to that
// speed as hard as its limits allow, and brakes in time for its end. Where it is too late for that,
// because the last braking has begun, it stays as it is up to the next moment without acceleration;
// a joint in its last braking is not stopped by anything before its end. A top speed of 0 is a
// hold: the law rests where it comes to and waits for the next event.
#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/joint_way.h"
#include "plan/law_writer.h"

namespace aircut::plan {
namespace {

struct Law {
  SpeedProfile profile;
  double way = 0;  ///< in all
  StraightLimits limits{};

  bool done() const { return profile.knots.back().s >= way; }
};

// From a state without acceleration: the highest speed up to `top` that leaves room to brake within
// `rest`; where already `speed` is above it, the lowest.
double peak_of(double speed, double top, double rest, const StraightLimits& limits) {
  const auto way = [&](double v0, double v1) {
    return (v0 + v1) / 2 * change_time(std::abs(v1 - v0), limits);
  };
  const auto fits = [&](double peak) { return way(speed, peak) + way(peak, 0) <= rest; };
  if (fits(top)) return top;
  double good = speed, bad = top;
  for (int i = 0; i < 200 && std::abs(good - bad) > 1e-15 * std::max(good, bad); ++i) {
    const double middle = (good + bad) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

// The law with another top speed from time t on; nothing when it could not brake in time.
std::optional<SpeedProfile> changed_at(const Law& law, double t, double top) {
  const SpeedProfile::State now = law.profile.at(t);
  LawWriter writer(ProfileKnot{t, now.s, now.v, now.a, 0});
  writer.relax(law.limits);
  const double speed = writer.v(), rest = law.way - writer.s();
  if (speed < 0 || speed / 2 * change_time(speed, law.limits) > rest) return std::nullopt;
  const double peak = peak_of(speed, top, rest, law.limits);
  writer.change(peak, law.limits);
  if (peak > 0) {
    const double left = law.way - writer.s() - peak / 2 * change_time(peak, law.limits);
    writer.cruise(std::max(left, 0.0) / peak);
    writer.change(0, law.limits);
  }
  SpeedProfile behind = writer.finish(peak > 0 ? law.way : writer.s());
  SpeedProfile out;
  for (const ProfileKnot& knot : law.profile.knots)
    if (knot.t < t) out.knots.push_back(knot);
  out.knots.insert(out.knots.end(), behind.knots.begin(), behind.knots.end());
  return out;
}

void change(Law& law, double t, double factor) {
  if (law.profile.duration() > 0 && t >= law.profile.duration() && law.done()) return;
  const double top = factor * law.limits.v;
  auto changed = changed_at(law, t, top);
  for (std::size_t i = 0; !changed && i + 1 < law.profile.knots.size(); ++i) {
    const ProfileKnot& knot = law.profile.knots[i];
    if (knot.t > t && knot.a == 0) changed = changed_at(law, knot.t, top);
  }
  if (changed) law.profile = std::move(*changed);
}

// The laws of a rapid: one for all joints, or one each.
std::vector<Law> laws_of(const Segment& segment, const JointLimits& limits) {
  const auto& way = std::get<JointWay>(segment.path);
  const machine::JointVector change = way.to - way.from;
  std::vector<Law> out;
  if (way.laws.empty()) {
    out.push_back({segment.profile, way.length, limits_along(limits, change, way.length)});
    return out;
  }
  for (Eigen::Index j = 0; j < change.size(); ++j)
    if (change[j] != 0)
      out.push_back({way.laws[static_cast<std::size_t>(j)],
                     std::abs(change[j]),
                     {limits.v[j], limits.a[j], limits.j[j]}});
  return out;
}

double longest(const std::vector<Law>& laws) {
  double out = 0;
  for (const Law& law : laws) out = std::max(out, law.profile.duration());
  return out;
}

void put_back(std::vector<Law> laws, Segment& segment) {
  auto& way = std::get<JointWay>(segment.path);
  if (way.laws.empty()) {
    segment.profile = std::move(laws.front().profile);
    return;
  }
  way.seconds = longest(laws);
  std::size_t next = 0;
  for (SpeedProfile& law : way.laws)
    if (!law.knots.empty()) law = std::move(laws[next++].profile);
  const double speed = way.length / way.seconds;
  segment.profile.knots = {{0, 0, speed, 0, 0}, {way.seconds, way.length, speed, 0, 0}};
}

}  // namespace

StraightLimits limits_along(const JointLimits& limits, const machine::JointVector& change,
                            double length) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  StraightLimits out{infinity, infinity, infinity};
  for (Eigen::Index j = 0; j < change.size(); ++j) {
    if (change[j] == 0) continue;
    const double per_way = length / std::abs(change[j]);
    out.v = std::min(out.v, limits.v[j] * per_way);
    out.a = std::min(out.a, limits.a[j] * per_way);
    out.j = std::min(out.j, limits.j[j] * per_way);
  }
  return out;
}

void override_joint_way(Segment& segment, const JointLimits& limits, Overrides& overrides,
                        double now) {
  std::vector<Law> laws = laws_of(segment, limits);
  const auto factor_now = [&] { return std::min(overrides.factor(segment), 1.0); };
  overrides.apply(now);
  double factor = factor_now(), least = factor;
  if (factor != 1)
    for (Law& law : laws) {
      law.profile.knots = {{0, 0, 0, 0, 0}};
      change(law, 0, factor);
    }
  const auto done = [](const Law& law) { return law.done(); };
  for (;;) {
    const double t = overrides.next() - now;
    if (!(t < longest(laws)) && (std::all_of(laws.begin(), laws.end(), done) || std::isinf(t)))
      break;
    overrides.apply(overrides.next());
    if (factor_now() == factor) continue;
    factor = factor_now();
    least = std::min(least, factor);
    for (Law& law : laws) change(law, t, factor);
  }
  if (least == 1) return;
  segment.limited_by = {LimitedBy::feed, -1};
  put_back(std::move(laws), segment);
}

}  // namespace aircut::plan
