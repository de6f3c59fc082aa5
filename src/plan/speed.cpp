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

// The half-planes of one interval. A row |p u + q b| ≤ room leaves u between two parallel lines
// over b: middle · b ± half.
class Interval {
 public:
  Interval(const Grid& grid, std::size_t node, double b_next)
      : ds_(grid.at[node + 1].s - grid.at[node].s),
        cap_(grid.at[node].cap),
        room_(grid.at[node].room),
        ramp_(1 / (2 * ds_)),
        end_(b_next * ramp_) {
    const double* alpha0 = grid.alpha(node);
    const double* beta0 = grid.beta(node);
    const double* alpha1 = grid.alpha(node + 1);
    const double* beta1 = grid.beta(node + 1);
    for (int j = 0; j < grid.joints; ++j) {
      add(alpha0[j], beta0[j]);
      add(alpha1[j] + 2 * ds_ * beta1[j], beta1[j]);
    }
  }

  // Largest b for which some u exists.
  double largest_b() const {
    double b = cap_;
    if (b == infinity) b = largest_finite_b();
    for (std::size_t round = 0; round < 8 * count_ + 16; ++round) {
      const Room room = room_at(b);
      const double width = room.high - room.low;
      if (width >= 0) return b;
      const double slope = room.high_slope - room.low_slope;
      if (!(slope < 0)) return 0;  // rounding at a vertex next to standstill
      const double next = b - width / slope;
      if (!(next < b)) return b;
      b = std::max(next, 0.0);
    }
    return b;
  }

  // Largest u at b; at a vertex, where rounding can leave nothing, the middle of the crossing.
  double largest_u(double b) const {
    const Room room = room_at(b);
    return room.high >= room.low ? room.high : (room.high + room.low) / 2;
  }
  double ds() const { return ds_; }

 private:
  void add(double p, double q) {
    if (p == 0) {
      if (q != 0) cap_ = std::min(cap_, room_ / std::abs(q));
      return;
    }
    const double over = 1 / p;
    middle_[count_] = -q * over;
    half_[count_] = room_ * std::abs(over);
    ++count_;
  }
  // u at b, and how the bounds change with b. The speed at the interval's end gives the first two.
  struct Room {
    double low, high, low_slope, high_slope;
  };
  Room room_at(double b) const {
    Room out{-ramp_ * b, end_ - ramp_ * b, -ramp_, -ramp_};
    for (std::size_t i = 0; i < count_; ++i) {
      const double u = middle_[i] * b;
      if (u + half_[i] < out.high) {
        out.high = u + half_[i];
        out.high_slope = middle_[i];
      }
      if (u - half_[i] > out.low) {
        out.low = u - half_[i];
        out.low_slope = middle_[i];
      }
    }
    return out;
  }
  // Without any cap the rows themselves end at some b: where every pair of lines has crossed.
  double largest_finite_b() const {
    double b = 0;
    const auto cross = [&b](double high, double high_slope, double low, double low_slope) {
      if (high_slope < low_slope) b = std::max(b, (high - low) / (low_slope - high_slope));
    };
    for (std::size_t i = 0; i < count_; ++i) {
      cross(half_[i], middle_[i], 0, -ramp_);
      cross(end_, -ramp_, -half_[i], middle_[i]);
      for (std::size_t k = 0; k < count_; ++k) cross(half_[i], middle_[i], -half_[k], middle_[k]);
    }
    return b;
  }

  double ds_;
  double cap_;
  double room_;
  double ramp_;  ///< u = (b_next − b) · ramp reaches b_next at the end
  double end_;
  std::size_t count_ = 0;
  std::array<double, 2 * machine::max_joints> middle_, half_;
};

Cause cause_at(const Grid& grid, std::size_t node, double b0, double b1, double u) {
  const GridNode& here = grid.at[node];
  if (b0 >= here.cap * (1 - 1e-9) && b1 >= grid.at[node + 1].cap * (1 - 1e-9)) return here.why;
  // The joint that uses most of its acceleration, at either end.
  Cause out{LimitedBy::acceleration, 0};
  double most = -1;
  for (int j = 0; j < grid.joints; ++j) {
    const double share =
        std::max(std::abs(grid.alpha(node)[j] * u + grid.beta(node)[j] * b0),
                 std::abs(grid.alpha(node + 1)[j] * u + grid.beta(node + 1)[j] * b1));
    if (share > most) {
      most = share;
      out.joint = static_cast<signed char>(j);
    }
  }
  return out;
}

struct RideMaker {
  Ride ride;
  double t = 0;
  double s = 0;

  // Constant acceleration from b0 to b1 over ds.
  void go(double ds, double b0, double b1, Cause cause) {
    if (!(ds > 0)) return;
    const double v0 = std::sqrt(b0), v1 = std::sqrt(b1);
    const double dt = 2 * ds / (v0 + v1);
    ride.profile.knots.push_back({t, s, v0, (b1 - b0) / (2 * ds), 0});
    ride.spent.add(cause, dt);
    t += dt;
    s += ds;
  }
};

Ride ride_uniform(const Grid& grid, double b_start, double b_end) {
  const double length = grid.length(), a = grid.uniform_a;
  const double cap = grid.at.front().cap;
  const Cause ramp{LimitedBy::acceleration, grid.uniform_joint};
  b_end = std::min(b_end, b_start + 2 * a * length);
  const double peak = std::min(cap, (b_start + b_end) / 2 + a * length);
  const double up = (peak - b_start) / (2 * a), down = (peak - b_end) / (2 * a);
  const double cruise = std::max(length - up - down, 0.0);
  RideMaker maker;
  maker.ride.profile.knots.reserve(4);
  maker.go(up, b_start, peak, ramp);
  if (peak >= cap) maker.go(cruise, peak, peak, grid.at.front().why);
  maker.go(down, peak, b_end, ramp);
  maker.ride.profile.knots.push_back({maker.t, length, std::sqrt(b_end), 0, 0});
  maker.ride.b_end = b_end;
  return std::move(maker.ride);
}

}  // namespace

Cause CauseTimes::longest() const {
  Cause out;
  double most = 0;
  for (std::size_t by = 0; by < time_.size(); ++by)
    for (std::size_t j = 0; j < time_[by].size(); ++j)
      if (time_[by][j] > most) {
        most = time_[by][j];
        out = {static_cast<LimitedBy>(by), static_cast<signed char>(static_cast<int>(j) - 1)};
      }
  return out;
}

void brake(const Grid& grid, double b_end, Controllable& out) {
  const std::size_t n = grid.nodes();
  out.resize(n);
  out[n - 1] = std::min(grid.at[n - 1].cap, b_end);
  if (grid.uniform) {
    out[0] = std::min(grid.at[0].cap, out[n - 1] + 2 * grid.uniform_a * grid.length());
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
    maker.go(interval.ds(), b, next, cause_at(grid, k, b, next, u));
    b = next;
  }
  maker.ride.profile.knots.push_back({maker.t, grid.length(), std::sqrt(b), 0, 0});
  maker.ride.b_end = b;
  return std::move(maker.ride);
}

}  // namespace aircut::plan
