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
#include <optional>

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

  // Smallest u at b: the hardest braking that does not run backwards.
  double smallest_u(double b) const {
    const Room room = room_at(b);
    return room.high >= room.low ? room.low : (room.high + room.low) / 2;
  }

  // Largest u at b; at a vertex, where rounding can leave nothing, the middle of the crossing.
  double largest_u(double b) const {
    const Room room = room_at(b);
    return room.high >= room.low ? room.high : (room.high + room.low) / 2;
  }

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
  std::array<double, 2 * (machine::max_joints + most_tip_rows)> middle_, half_;
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
      out.joint = static_cast<signed char>(j < grid.joints - grid.tip_rows ? j : -1);
    }
  }
  return out;
}

// True where every row allows going from b0 to b1 over the interval behind `node`; then the highest
// speed that is asked for at either end is reached and nothing needs to be solved.
bool allows(const Grid& grid, std::size_t node, double b0, double b1, double u) {
  const double *alpha0 = grid.alpha(node), *beta0 = grid.beta(node);
  const double *alpha1 = grid.alpha(node + 1), *beta1 = grid.beta(node + 1);
  const double room = grid.at[node].room;
  bool good = true;
  for (int j = 0; j < grid.joints; ++j)
    good = good & (std::abs(alpha0[j] * u + beta0[j] * b0) <= room) &
           (std::abs(alpha1[j] * u + beta1[j] * b1) <= room);
  return good;
}

// The acceleration from b0 to b1 over the interval behind `node`, rounded as an Interval does it.
double acceleration_to(const Grid& grid, std::size_t node, double b0, double b1) {
  const double ramp = 1 / (2 * (grid.at[node + 1].s - grid.at[node].s));
  return b1 * ramp - ramp * b0;
}

// A braking from b that comes to rest inside the interval behind `node`, if there is one: all rows
// of both ends hold for it at b and at rest, so they do in between. Without it a motion that is
// nearly at rest would crawl to the next node.
std::optional<double> braking_to_rest(const Grid& grid, std::size_t node, double b) {
  const double room = grid.at[node].room;
  double steepest = infinity;
  for (const std::size_t end : {node, node + 1})
    for (int j = 0; j < grid.joints; ++j)
      steepest = std::min(steepest, room / std::max(std::abs(grid.alpha(end)[j]), 1e-300));
  for (double u = -steepest; - u > steepest / 16; u /= 2)
    if (allows(grid, node, b, b, u)) return u;
  return std::nullopt;
}

struct RideMaker {
  Ride ride;
  CauseTimes spent;
  double t = 0;
  double s = 0;

  // Constant acceleration from b0 to b1 over ds.
  void go(double ds, double b0, double b1, Cause cause) {
    if (!(ds > 0)) return;
    const double v0 = std::sqrt(b0), v1 = std::sqrt(b1);
    const double dt = 2 * ds / (v0 + v1);
    ride.profile.knots.push_back({t, s, v0, (b1 - b0) / (2 * ds), 0});
    spent.add(cause, dt);
    t += dt;
    s += ds;
  }

  Ride finish(double length, double b_end) {
    ride.profile.knots.push_back({t, length, std::sqrt(b_end), 0, 0});
    ride.b_end = b_end;
    ride.limited_by = spent.longest();
    return std::move(ride);
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
  return maker.finish(length, b_end);
}

}  // namespace

void CauseTimes::add(Cause cause, double seconds) {
  for (std::size_t i = 0; i < count_; ++i)
    if (cause_[i] == cause) {
      seconds_[i] += seconds;
      return;
    }
  cause_[count_] = cause;
  seconds_[count_++] = seconds;
}

Cause CauseTimes::longest() const {
  Cause out;
  double longest = 0;
  // Between equals the first in the order of causes and joints, whatever came first on the way.
  for (std::size_t i = 0; i < count_; ++i)
    if (seconds_[i] > longest || (seconds_[i] == longest && longest > 0 && cause_[i] < out)) {
      longest = seconds_[i];
      out = cause_[i];
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
  for (std::size_t k = n - 1; k-- > 0;) {
    const double cap = grid.at[k].cap, next = out[k + 1];
    out[k] = allows(grid, k, cap, next, acceleration_to(grid, k, cap, next))
                 ? cap
                 : Interval(grid, k, next).largest_b();
  }
}

Descent descend(const Grid& grid, const Controllable& controllable, double b_start) {
  Descent out;
  RideMaker maker;
  double b = b_start;
  const auto go = [&](double ds, double next, Cause cause) {
    maker.go(ds, b, next, cause);
    b = next;
  };
  if (grid.uniform) {
    // Both fall with the same slope; only the cap can be met on the way.
    const double a = grid.uniform_a, cap = grid.at.front().cap;
    const bool meets = b_start <= controllable.back() + 2 * a * grid.length() * (1 + 1e-12);
    const double way = std::max((b_start - cap) / (2 * a), 0.0);
    out.done = meets && way < grid.length();
    const double ds = out.done ? way : grid.length();
    go(ds, out.done ? cap : std::max(b_start - 2 * a * ds, 0.0),
       {LimitedBy::acceleration, grid.uniform_joint});
  } else {
    for (std::size_t k = 0; k + 1 < grid.nodes() && !out.done; ++k) {
      const double ds = grid.at[k + 1].s - grid.at[k].s;
      double u = Interval(grid, k, infinity).smallest_u(b), next = std::max(b + 2 * u * ds, 0.0);
      if (next <= 1e-9 * b && controllable[k] == 0 && controllable[k + 1] == 0)
        if (const auto harder = braking_to_rest(grid, k, b); harder && *harder < u) {
          u = *harder;
          next = b + 2 * u * ds;  // below 0: it rests before
        }
      const double over = b - controllable[k], later = next - controllable[k + 1];
      const double f = over <= 0 ? 0 : later <= 0 ? over / (over - later) : 1;
      out.done = over <= 0 || later <= 0;
      const Cause cause = cause_at(grid, k, b, next, u);
      if (over <= 0) break;
      // Where both meet it is what is asked for, to the bit: rest is rest.
      const double met = controllable[k] + f * (controllable[k + 1] - controllable[k]);
      if (out.done && f > 1 - 1e-9)
        go(ds, std::clamp(next, 0.0, controllable[k + 1]), cause);
      else
        go(f * ds, out.done ? met : next, cause);
    }
  }
  out.s = maker.s;
  out.ride = maker.finish(maker.s, b);
  return out;
}

Ride accelerate(const Grid& grid, const Controllable& controllable, double b_start) {
  if (grid.uniform) return ride_uniform(grid, b_start, controllable.back());
  RideMaker maker;
  maker.ride.profile.knots.reserve(grid.nodes());
  double b = b_start;
  for (std::size_t k = 0; k + 1 < grid.nodes(); ++k) {
    const double ds = grid.at[k + 1].s - grid.at[k].s, most = controllable[k + 1];
    double u = acceleration_to(grid, k, b, most);
    if (!allows(grid, k, b, most, u)) u = Interval(grid, k, most).largest_u(b);
    const double next = std::clamp(b + 2 * u * ds, 0.0, most);
    maker.go(ds, b, next, cause_at(grid, k, b, next, u));
    b = next;
  }
  return maker.finish(grid.length(), b);
}

}  // namespace aircut::plan
