// Time-optimal speed by reachability: a backward pass finds, per node, the largest squared speed
// from which the rest can still be braked; a forward pass takes the largest acceleration that stays
// below it. (Idea: Bobrow 1985; as reachability, H. Pham and Q.-C. Pham 2018.)
//
// b = ṡ² is linear in s between nodes, so u = s̈ is constant there: b1 = b0 + 2 u ds. Every limit is
// linear in (u, b): |α u + β b| ≤ 1 at both ends of the interval with that same u. Backward step:
// the largest b0 for which some u exists. For a given b0 the rows leave an interval of u, from the
// highest lower line to the lowest upper line; its width is a concave, piecewise linear function of
// b0, so walking down from the cap along the two active lines (Newton) ends at the exact vertex.
// Standing still is always feasible, so the feasible speeds are an interval that starts at 0.
//
// A uniform piece has |u| ≤ a and a constant cap: all of that in closed form.
#include "plan/speed.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A bound of u as a line over b: value + slope · b.
struct Bound {
  double value, slope;
  double at(double b) const { return value + slope * b; }
};

// The half-planes of one interval.
class Interval {
 public:
  Interval(const Grid& grid, std::size_t node, double b_next)
      : ds_(grid.s[node + 1] - grid.s[node]), cap_(grid.cap[node]), room_(grid.room[node]) {
    const double* alpha0 = grid.alpha(node);
    const double* beta0 = grid.beta(node);
    const double* alpha1 = grid.alpha(node + 1);
    const double* beta1 = grid.beta(node + 1);
    for (int j = 0; j < grid.joints; ++j) {
      add(alpha0[j], beta0[j]);
      add(alpha1[j] + 2 * ds_ * beta1[j], beta1[j]);
    }
    lower_[count_] = {0, -1 / (2 * ds_)};
    upper_[count_] = {b_next / (2 * ds_), -1 / (2 * ds_)};
    ++count_;
  }

  // Largest b for which some u exists.
  double largest_b() const {
    double b = cap_;
    if (b == infinity) b = largest_finite_b();
    for (std::size_t round = 0; round < 4 * count_ + 8; ++round) {
      const Bound low = lowest(b), high = highest(b);
      const double width = high.at(b) - low.at(b);
      if (width >= 0) return b;
      const double slope = high.slope - low.slope;
      if (!(slope < 0)) return 0;  // rounding at a vertex next to standstill
      const double next = b - width / slope;
      if (!(next < b)) return b;
      b = std::max(next, 0.0);
    }
    return b;
  }

  // Largest u at b; at a vertex, where rounding can leave nothing, the middle of the crossing.
  double largest_u(double b) const {
    const double high = highest(b).at(b), low = lowest(b).at(b);
    return high >= low ? high : (high + low) / 2;
  }
  double ds() const { return ds_; }

 private:
  void add(double p, double q) {
    if (p == 0) {
      if (q != 0) cap_ = std::min(cap_, room_ / std::abs(q));
      return;
    }
    // ±(p u + q b) ≤ room
    const double sign = p > 0 ? room_ : -room_;
    upper_[count_] = {sign / p, -q / p};
    lower_[count_] = {-sign / p, -q / p};
    ++count_;
  }
  // Without any cap the rows themselves end at some b: where every pair of lines has crossed.
  double largest_finite_b() const {
    double b = 0;
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t k = 0; k < count_; ++k)
        if (const double slope = upper_[i].slope - lower_[k].slope; slope < 0)
          b = std::max(b, (upper_[i].value - lower_[k].value) / -slope);
    return b;
  }
  Bound highest(double b) const {  // the lowest of the upper lines
    Bound best = upper_[0];
    for (std::size_t i = 1; i < count_; ++i)
      if (upper_[i].at(b) < best.at(b)) best = upper_[i];
    return best;
  }
  Bound lowest(double b) const {
    Bound best = lower_[0];
    for (std::size_t i = 1; i < count_; ++i)
      if (lower_[i].at(b) > best.at(b)) best = lower_[i];
    return best;
  }

  double ds_;
  double cap_;
  double room_;
  std::size_t count_ = 0;
  std::array<Bound, 2 * machine::max_joints + 1> upper_, lower_;
};

LimitedBy cause_at(const Grid& grid, std::size_t node, double b0, double b1) {
  const bool capped = b0 >= grid.cap[node] * (1 - 1e-9) && b1 >= grid.cap[node + 1] * (1 - 1e-9);
  if (!capped) return LimitedBy::acceleration;
  return grid.why[node] == Cap::feed ? LimitedBy::feed : LimitedBy::velocity;
}

struct RideMaker {
  Ride ride;
  double t = 0;
  double s = 0;

  // Constant acceleration from b0 to b1 over ds.
  void go(double ds, double b0, double b1, LimitedBy cause) {
    if (!(ds > 0)) return;
    const double v0 = std::sqrt(b0), v1 = std::sqrt(b1);
    const double dt = 2 * ds / (v0 + v1);
    ride.profile.knots.push_back({t, s, v0, (b1 - b0) / (2 * ds), 0});
    ride.time[static_cast<std::size_t>(cause)] += dt;
    t += dt;
    s += ds;
  }
};

Ride ride_uniform(const Grid& grid, double b_start, double b_end) {
  const double length = grid.length(), a = grid.uniform_a;
  const double cap = grid.cap.front();
  b_end = std::min(b_end, b_start + 2 * a * length);
  const double peak = std::min(cap, (b_start + b_end) / 2 + a * length);
  const double up = (peak - b_start) / (2 * a), down = (peak - b_end) / (2 * a);
  const double cruise = std::max(length - up - down, 0.0);
  RideMaker maker;
  maker.ride.profile.knots.reserve(4);
  maker.go(up, b_start, peak, LimitedBy::acceleration);
  if (peak >= cap)
    maker.go(cruise, peak, peak,
             grid.why.front() == Cap::feed ? LimitedBy::feed : LimitedBy::velocity);
  maker.go(down, peak, b_end, LimitedBy::acceleration);
  maker.ride.profile.knots.push_back({maker.t, length, std::sqrt(b_end), 0, 0});
  maker.ride.b_end = b_end;
  return std::move(maker.ride);
}

}  // namespace

void brake(const Grid& grid, double b_end, Controllable& out) {
  const std::size_t n = grid.nodes();
  out.resize(n);
  out[n - 1] = std::min(grid.cap[n - 1], b_end);
  if (grid.uniform) {
    out[0] = std::min(grid.cap[0], out[n - 1] + 2 * grid.uniform_a * grid.length());
    return;
  }
  for (std::size_t k = n - 1; k-- > 0;) out[k] = Interval(grid, k, out[k + 1]).largest_b();
}

Ride accelerate(const Grid& grid, const Controllable& controllable, double b_start) {
  if (grid.uniform) return ride_uniform(grid, b_start, controllable.back());
  RideMaker maker;
  maker.ride.profile.knots.reserve(grid.nodes());
  double b = b_start;
  for (std::size_t k = 0; k + 1 < grid.nodes(); ++k) {
    const Interval interval(grid, k, controllable[k + 1]);
    const double u = interval.largest_u(b);
    const double next = std::clamp(b + 2 * u * interval.ds(), 0.0, controllable[k + 1]);
    maker.go(interval.ds(), b, next, cause_at(grid, k, b, next));
    b = next;
  }
  maker.ride.profile.knots.push_back({maker.t, grid.length(), std::sqrt(b), 0, 0});
  maker.ride.b_end = b;
  return std::move(maker.ride);
}

}  // namespace aircut::plan
