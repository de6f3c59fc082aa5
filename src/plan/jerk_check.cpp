// Two looks at a law. The first is cheap and sees every phase of the samples: the third difference
// of q over T is that of the mean speed over T, taken by Simpson's rule from q' at the stations. It
// says where the solver's means over cells allowed too much. The second decides: it computes the
// samples that the log will hold, from the path and the inverse kinematics, and takes their
// differences, over the joint to what went out before too.
#include "plan/jerk_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aircut::plan {
namespace {

constexpr double seen_share = 0.994;     // of a jerk limit, at any phase
constexpr double logged_share = 1.0003;  // of a limit, in the log
constexpr double feed_room = 1.0005;     // of the feed, in the log

// q'/A times the path's speed every quarter of a period, rows of joints.
std::vector<double> speeds(const JerkWindow& w, const WindowLaw& law, double first, double step,
                           std::size_t count) {
  const double begin = law.knots.front().t, end = law.knots.back().t;
  std::vector<double> out(count * w.joints, 0.0), alpha(w.joints);
  std::size_t knot = 0, station = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = first + static_cast<double>(i) * step;
    if (t <= begin && w.start.from_rest) continue;
    if (t >= end) break;
    while (knot + 2 < law.knots.size() && law.knots[knot + 1].t <= t) ++knot;
    const LawKnot& k = law.knots[knot];
    const double tau = std::max(t - k.t, 0.0), v = k.speed(tau);
    w.rates_at(k.way(tau), station, alpha.data());
    for (std::size_t j = 0; j < w.joints; ++j) out[i * w.joints + j] = alpha[j] * v;
  }
  return out;
}

}  // namespace

std::vector<Excess> jerk_excess(const JerkWindow& w, const WindowLaw& law) {
  const double step = w.period / 4, begin = law.knots.front().t, end = law.knots.back().t;
  const double first = begin - (w.start.from_rest ? 8 * step : 0);
  const auto count = static_cast<std::size_t>((end - begin) / step) + 17;
  const std::vector<double> speed = speeds(w, law, first, step, count);
  const auto mean = [&](std::size_t i, std::size_t j) {
    const auto at = [&](std::size_t k) { return speed[k * w.joints + j]; };
    return (at(i - 2) + 4 * at(i - 1) + 2 * at(i) + 4 * at(i + 1) + at(i + 2)) / 12;
  };
  std::vector<Excess> out;
  for (std::size_t i = 6; i + 6 < count; ++i) {
    double worst = 0;
    for (std::size_t j = 0; j < w.joints; ++j) {
      const double rate = w.rate[static_cast<Eigen::Index>(j)];
      const double jerk =
          (mean(i + 4, j) - 2 * mean(i, j) + mean(i - 4, j)) / (w.period * w.period);
      worst = std::max(worst, std::abs(jerk) / rate);
    }
    if (worst > seen_share) out.push_back({first + static_cast<double>(i) * step, worst});
  }
  return out;
}

namespace {

// The squared speed is straight between nodes. Where a lower feed begins between two of them, the
// one before it is too fast for that feed: both get no more than it allows.
void trim_speed(const Excess& e, const JerkWindow& w, const NodePlan& plan, const WindowLaw& law,
                Trim& trim) {
  const auto& times = law.node_time;
  const auto first = std::upper_bound(times.begin(), times.end(), e.t - w.period) - times.begin();
  const auto last = std::lower_bound(times.begin(), times.end(), e.t) - times.begin();
  for (auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first - 1, 0));
       k < trim.speed.size() && k <= static_cast<std::size_t>(last); ++k) {
    const double cap = std::sqrt(plan.cap[k]);
    const double speed = std::min(e.allowed, cap / e.share);  // less than before, with each repair
    trim.speed[k] = std::min(trim.speed[k], plan.trim.speed[k] * speed / cap);
  }
}

}  // namespace

void trim_around(const std::vector<Excess>& excess, const JerkWindow& w, const NodePlan& plan,
                 const WindowLaw& law, bool slower, Trim& trim) {
  const Trim before = trim;
  const double reach = 3 * w.period;
  std::size_t low = 0;
  for (const Excess& e : excess) {
    if (e.allowed > 0) {
      trim_speed(e, w, plan, law, trim);
      continue;
    }
    while (low + 1 < law.node_time.size() && law.node_time[low] < e.t - reach) ++low;
    for (std::size_t k = low; k < trim.jerk.size() && law.node_time[k] <= e.t + reach; ++k) {
      trim.jerk[k] = std::min(trim.jerk[k], std::max(0.98 / e.share, 0.5) * before.jerk[k]);
      if (slower) trim.speed[k] = std::min(trim.speed[k], 0.95 * before.speed[k]);
    }
  }
}

LogSamples::LogSamples(const machine::Kinematics& kinematics, const JointLimits& limits,
                       machine::JointVector start, double period)
    : kinematics_(kinematics), limits_(limits), period_(period) {
  past_.push_back({-1, std::move(start), {}});
}

void LogSamples::pass(const Segment& segment, double clock) {
  const double end = clock + segment.duration();
  // The log takes a sample from the first segment that ends after it.
  double number = std::max(std::ceil(clock / period_), std::ceil(end / period_) - 4);
  for (; number * period_ < end; ++number) {
    if (number <= past_.back().number) continue;
    const double s = segment.profile.at(std::max(number * period_ - clock, 0.0)).s;
    const AxisValues tip = evaluate(segment.path, s).p;
    const auto* way = std::get_if<JointWay>(&segment.path);
    auto q = way ? tl::expected<machine::JointVector, machine::ReachError>(joint_point(*way, s).q)
                 : kinematics_of(segment, kinematics_)
                       .inverse({tip, segment.tool_offset}, past_.back().q);
    past_.push_back({number, q ? std::move(*q) : past_.back().q, tip, segment.feed});
    if (past_.size() > 4) past_.pop_front();
  }
}

const LogSamples::Sample& LogSamples::before(double number) const {
  for (auto sample = past_.rbegin(); sample != past_.rend(); ++sample)
    if (sample->number <= number) return *sample;
  return past_.front();
}

// Share of the feed from one sample to the next: the tip's way in XYZ, else UVW, else ABC.
double LogSamples::feed_share(const Sample& from, const Sample& to, double period) {
  if (!(from.feed > 0) || !(to.feed > 0)) return 0;
  constexpr double none = 1e-9;
  double way = 0;
  for (const Axis first : {Axis::x, Axis::u, Axis::a}) {
    const auto i = static_cast<std::size_t>(first);
    const auto along = [&](std::size_t k) { return to.tip.value[i + k] - from.tip.value[i + k]; };
    way = std::hypot(along(0), along(1), along(2));
    if (way >= none) break;
  }
  return way / period / std::max(from.feed, to.feed);
}

// Reads the joints of a ride, forward in time.
class LogSamples::Reader {
 public:
  Reader(const LogSamples& samples, const Ride& ride) : samples_(samples), ride_(ride) {}

  /// Nothing where the joints can't be computed.
  std::optional<Sample> at(double number) {
    const double t = ride_.cut + (number * samples_.period_ - ride_.clock);
    if (t < ride_.cut) {
      const Sample& past = samples_.before(number);
      near_ = past.q;
      return past;
    }
    if (near_.size() == 0) near_ = samples_.past_.back().q;
    const double x = way(t);
    while (item_ + 1 < ride_.items.size() && ride_.items[item_].end() <= x) ++item_;
    const WayItem& item = ride_.items[item_];
    const double s = std::clamp((x - item.begin) / item.stretch, 0.0, item.grid.length());
    const AxisValues tip = evaluate(item.segment.path, s).p;
    auto q = kinematics_of(item.segment, samples_.kinematics_)
                 .inverse({tip, item.segment.tool_offset}, near_);
    if (!q) return std::nullopt;
    near_ = *q;
    return Sample{number, std::move(*q), tip, item.segment.feed};
  }

  /// x at a sample of the ride.
  double way_at(double number) const {
    return state_at(ride_.law, ride_.cut + (number * samples_.period_ - ride_.clock)).x;
  }

 private:
  double way(double t) {
    if (t < ride_.law.front().t && !ride_.before.empty()) return state_at(ride_.before, t).x;
    if (t >= ride_.law.back().t) return ride_.law.back().x;
    while (knot_ + 2 < ride_.law.size() && ride_.law[knot_ + 1].t <= t) ++knot_;
    return ride_.law[knot_].way(std::max(t - ride_.law[knot_].t, 0.0));
  }

  const LogSamples& samples_;
  const Ride& ride_;
  machine::JointVector near_;
  std::size_t knot_ = 0, item_ = 0;
};

std::vector<Excess> LogSamples::excess(const Ride& ride, double until) const {
  const double begin = ride.law.front().t, end = std::min(until, ride.law.back().t);
  const auto number_at = [&](double t) {
    return std::ceil((ride.clock + (t - ride.cut)) / period_);
  };
  const double first = number_at(begin), last = number_at(end) + 3, t2 = period_ * period_;
  Reader reader(*this, ride);
  std::array<Sample, 4> at;
  std::vector<Excess> out;
  for (double number = first - 3; number < last; ++number) {
    auto now = reader.at(number);
    const double t = ride.cut + ((number - 1.5) * period_ - ride.clock);
    if (!now) {
      out.push_back({t, std::numeric_limits<double>::infinity()});
      continue;
    }
    std::rotate(at.begin(), at.begin() + 1, at.end());
    at[3] = std::move(*now);
    if (number < first) continue;
    const machine::JointVector &q0 = at[0].q, &q1 = at[1].q, &q2 = at[2].q, &q3 = at[3].q;
    double worst = 0;
    for (Eigen::Index j = 0; j < q3.size(); ++j) {
      const double bend = q3[j] - 2 * q2[j] + q1[j];
      const double change = bend - (q2[j] - 2 * q1[j] + q0[j]);
      worst = std::max({worst, std::abs(bend) / (t2 * limits_.a[j]),
                        std::abs(change) / (t2 * period_ * limits_.j[j])});
    }
    if (worst > logged_share) out.push_back({t, worst});
    const double feed = feed_share(at[2], at[3], period_);
    if (feed > feed_room) {
      const double speed = (reader.way_at(number) - reader.way_at(number - 1)) / period_;
      out.push_back({t + 1.5 * period_, feed, speed / feed});
    }
  }
  return out;
}

}  // namespace aircut::plan
