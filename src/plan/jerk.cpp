// From the second-order profile to one with limited jerk.
//
// Between two stops all pieces are laid on one way x. The second-order profile b₂(x) is the largest
// squared speed that any ride can have there, so it is the cap of the third-order one: feed, joint
// speeds and curvature need not be looked at again. Over it go nodes, about one per period of the
// log, and the solver (jerk_solver.h) finds the squared speeds b at them.
//
//   rows     What counts in a cell is the mean acceleration of each joint, the change of its speed
//            q' v over the time. With the mean α of q'/A at the ends and β = Δ(q'/A) / h it is
//            α u + β b, exact for the cell as a whole. So a cell may span many tiny pieces.
//   nodes    Equal steps of time on an estimate of the ride: near a stop x ~ t³, elsewhere b₂;
//   then,
//            on that coarse result, again in finer steps. Where nothing changes cells grow.
//   law      The solver's acceleration u is constant in a cell. Around each node a ramp as long as
//            the shorter neighbouring cell makes it continuous; jerk is then constant in pieces, so
//            x(t) is a chain of cubics: known in closed form, with a speed that is never negative.
//   windows  The way is planned to a stop at the end of what has come so far; all but the last
//            braking is final. The next window starts from the last final cell. The plan to that
//            stop is kept: should a window not be solved, it is carried out.
//
// A stretch on which all joints run straight with one limit has the closed form (s_curve.h).
#include "plan/jerk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/jerk_solver.h"
#include "plan/s_curve.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double acceleration_room = 0.998;
constexpr double jerk_room = 0.982;
constexpr double largest_violation = 2e-3;
// At a stop the smoothed law lasts half a cell longer than the nodes' times; nodes half a cell
// later give equal times there.
constexpr double half_cell = 0.5;
constexpr int most_meshes = 3;
constexpr int most_repairs = 12;
constexpr int first_slower_repair = 4;
constexpr double seen_share = 0.994;  // of a jerk limit, as samples see it

double path_jerk(const double* alpha, const machine::JointVector& rate) {
  double least = infinity;
  for (Eigen::Index j = 0; j < rate.size(); ++j)
    if (alpha[j] != 0) least = std::min(least, rate[j] / std::abs(alpha[j]));
  return least;
}

double linear(double x, double x0, double x1, double y0, double y1) {
  return x1 > x0 ? y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0) : y0;
}

}  // namespace

// Chooses nodes by an estimate of the time.
class JerkStage::Mesher {
 public:
  Mesher(const JerkStage& stage, double step)
      : stage_(stage), step_(step), begin_(stage.start_.x), end_(stage.way_end()) {}

  std::vector<double> make();

 private:
  static Place place(double x) { return {x, 0, 0, 0, 0, false}; }
  void put_places();
  void put_stop(double stop, double jerk, double sense);
  void put_speeds();
  void put_times();

  const JerkStage& stage_;
  double step_;
  double begin_, end_;
  double start_jerk_ = infinity, end_jerk_ = infinity;
  std::vector<Place> places_;
};

// From a stop on, with the jerk's limit: x = j t³ / 6. Places until the profile is slower.
void JerkStage::Mesher::put_stop(double stop, double jerk, double sense) {
  if (!std::isfinite(jerk)) return;
  const double dt = step_ / 4;
  for (int k = 1; k < 100000; ++k) {
    const double t = k * dt;
    const double x = stop + sense * jerk * t * t * t / 6;
    if (x <= begin_ || x >= end_) return;
    places_.push_back(place(x));
    if (t > 4 * stage_.brake_time_) return;
  }
}

void JerkStage::Mesher::put_places() {
  const auto& stations = stage_.stations_;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const double x0 = std::max(stations[i].x, begin_), x1 = std::min(stations[i + 1].x, end_);
    if (!(x1 > x0)) continue;
    const double sum = std::sqrt(stations[i].b) + std::sqrt(stations[i + 1].b);
    const double time = 2 * (x1 - x0) / std::max(sum, 1e-300);
    const int parts = static_cast<int>(std::clamp(time / (2 * step_), 1.0, 1000.0));
    for (int k = 0; k < parts; ++k) places_.push_back(place(x0 + (x1 - x0) * k / parts));
  }
  places_.push_back(place(end_));
  const auto joints = static_cast<std::ptrdiff_t>(stage_.joints_);
  if (stage_.start_.from_rest) {
    start_jerk_ = path_jerk(stage_.alpha_.data(), stage_.rate_);
    put_stop(begin_, start_jerk_, 1);
  }
  end_jerk_ = path_jerk(stage_.alpha_.data() + stage_.alpha_.size() - joints, stage_.rate_);
  put_stop(end_, end_jerk_, -1);
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.x < b.x; });
  const auto same = [](const Place& a, const Place& b) { return a.x == b.x; };
  places_.erase(std::unique(places_.begin(), places_.end(), same), places_.end());
}

void JerkStage::Mesher::put_speeds() {
  const auto& stations = stage_.stations_;
  std::size_t i = 0;
  for (Place& place : places_) {
    while (i + 2 < stations.size() && stations[i + 1].x <= place.x) ++i;
    const double b =
        linear(place.x, stations[i].x, stations[i + 1].x, stations[i].b, stations[i + 1].b);
    place.v = std::sqrt(std::max(b, 0.0));
  }
}

void JerkStage::Mesher::put_times() {
  const auto from_stop = [](double way, double jerk) {
    return std::isfinite(jerk) ? std::cbrt(6 * std::max(way, 0.0) / jerk) : 0.0;
  };
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const Place& a = places_[i - 1];
    Place& b = places_[i];
    const double mean = 2 * (b.x - a.x) / std::max(a.v + b.v, 1e-300);
    const double up = stage_.start_.from_rest ? from_stop(b.x - begin_, start_jerk_) -
                                                    from_stop(a.x - begin_, start_jerk_)
                                              : 0;
    const double down = from_stop(end_ - a.x, end_jerk_) - from_stop(end_ - b.x, end_jerk_);
    double time = std::max(mean, std::max(up, down));
    if (!(a.v + b.v > 0)) time = std::max(up, down);  // a way between two stops
    b.t = a.t + time;
  }
}

std::vector<double> JerkStage::Mesher::make() {
  put_places();
  put_speeds();
  put_times();
  for (std::size_t i = 0; i < places_.size(); ++i)
    for (const std::size_t k : {i - 1, i + 1})
      if (k < places_.size() && std::abs(places_[k].v - places_[i].v) > 1e-4 * places_[i].v)
        places_[i].active = true;
  stage_.put_targets(places_, step_);
  const double cells = std::max(std::ceil(places_.back().count), 24.0);
  const double lead = stage_.start_.from_rest ? half_cell : 0;
  std::vector<double> out = {begin_};
  std::size_t i = 0;
  const double total = places_.back().t;
  for (double k = 1; k < cells; ++k) {
    const double wanted = places_.back().count * (k + lead) / (cells + lead + half_cell);
    while (i + 2 < places_.size() && places_[i + 1].count <= wanted) ++i;
    const Place &a = places_[i], &b = places_[i + 1];
    const double t = linear(wanted, a.count, b.count, a.t, b.t);
    double x = linear(t, a.t, b.t, a.x, b.x);
    // Next to a stop x goes with the cube of the time.
    const double up = begin_ + start_jerk_ * t * t * t / 6;
    const double left = total - t, down = end_ - end_jerk_ * left * left * left / 6;
    if (stage_.start_.from_rest && up > a.x && up < b.x) x = up;
    if (down > a.x && down < b.x) x = down;
    if (x > out.back() && x < end_) out.push_back(x);
  }
  out.push_back(end_);
  return out;
}

JerkStage::JerkStage(const JointLimits& limits, machine::JointVector rate, double period)
    : a_(limits.a),
      rate_(std::move(rate)),
      period_(period),
      joints_(static_cast<std::size_t>(limits.a.size())) {
  for (Eigen::Index j = 0; j < a_.size(); ++j)
    brake_time_ = std::max(
        brake_time_, limits.v[j] / limits.a[j] + (std::isfinite(rate_[j]) ? 1 / rate_[j] : 0));
  next_plan_ = window_time();
}

void JerkStage::push(Segment segment, Grid grid, double scale) {
  Item item;
  if (!items_.empty()) {
    item.begin = items_.back().end();
    item.stretch = items_.back().stretch / scale;
  }
  item.segment = std::move(segment);
  item.grid = std::move(grid);
  waiting_ += item.segment.duration();
  items_.push_back(std::move(item));
  straight_ = straight_ && goes_on_straight(items_.back());
  // A straight stretch is planned as a whole, by its closed form.
  constexpr std::size_t most_straight = 20000;
  if (waiting_ > next_plan_ && (items_.size() > most_straight || !straight_)) {
    straight_ = false;
    plan_window(false);
  }
}

void JerkStage::push_still(Segment segment) {
  if (items_.empty())
    ready_.push_back(std::move(segment));
  else
    items_.back().after.push_back(std::move(segment));
}

void JerkStage::stop() {
  if (items_.empty()) return;
  if (straight_)
    plan_straight();
  else
    plan_window(true);
  rest_here();
}

std::vector<Segment> JerkStage::take() { return std::exchange(ready_, {}); }

// After all of the law is carried out: the next stretch starts at rest.
void JerkStage::rest_here() {
  hand_out(law_end_);
  law_.clear();
  start_ = {};
  straight_ = items_.empty();
  final_t_ = law_end_ = cut_t_ = 0;
  next_plan_ = window_time();
  double begin = 0;
  for (Item& item : items_) {
    item.begin = begin;
    begin = item.end();
  }
}

// True if the joints run on as in the first piece, with the same limits.
bool JerkStage::goes_on_straight(const Item& item) const {
  const Item& first = items_.front();
  if (!first.grid.uniform || !item.grid.uniform) return false;
  const machine::JointVector dq = first.grid.dq_start / first.stretch;
  const double cap = first.grid.cap.front() * first.stretch * first.stretch;
  const double here = item.grid.cap.front() * item.stretch * item.stretch;
  if (std::abs(here - cap) > 1e-9 * cap && here != cap) return false;
  return (item.grid.dq_start / item.stretch - dq).norm() <= 1e-9 * dq.norm();
}

void JerkStage::plan_straight() {
  const Item& first = items_.front();
  const machine::JointVector alpha = first.grid.dq_start.cwiseQuotient(a_) / first.stretch;
  StraightLimits limits{};
  limits.v = std::sqrt(first.grid.cap.front()) * first.stretch;
  limits.a = 1 / alpha.cwiseAbs().maxCoeff();
  limits.j = path_jerk(alpha.data(), rate_);
  if (!std::isfinite(limits.j)) {
    // No joint that moves has a jerk limit: the second-order profile stays.
    for (Item& item : items_) {
      ready_.push_back(std::move(item.segment));
      for (Segment& still : item.after) ready_.push_back(std::move(still));
    }
    items_.clear();
    waiting_ = 0;
    return;
  }
  const SpeedProfile profile = s_curve(way_end(), limits);
  law_.clear();
  for (const ProfileKnot& k : profile.knots) {
    LimitedBy cause = LimitedBy::jerk;
    if (k.j == 0 && k.a != 0) cause = LimitedBy::acceleration;
    if (k.j == 0 && k.a == 0)
      cause = first.grid.why.front() == Cap::feed ? LimitedBy::feed : LimitedBy::velocity;
    law_.push_back({k.t, k.s, k.v, k.a, k.j, cause});
  }
  final_t_ = law_end_ = profile.duration();
  rest_x_ = way_end();
}

void JerkStage::read_stations() {
  stations_.clear();
  alpha_.clear();
  beta_.clear();
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const Item& item = items_[i];
    if (item.end() <= start_.x && i + 1 < items_.size()) continue;
    const double f = item.stretch;
    const auto& knots = item.segment.profile.knots;
    for (std::size_t k = 0; k < knots.size(); ++k) {
      stations_.push_back({k + 1 == knots.size() ? item.end() : item.begin + f * knots[k].s,
                           f * f * knots[k].v * knots[k].v, i});
      for (std::size_t j = 0; j < joints_; ++j) {
        const auto row = static_cast<Eigen::Index>(j);
        alpha_.push_back(
            (item.grid.uniform ? item.grid.dq_start[row] / a_[row] : item.grid.alpha(k)[j]) / f);
        beta_.push_back(item.grid.uniform ? 0 : item.grid.beta(k)[j] / (f * f));
      }
    }
  }
}

// Wanted durations of cells: the step where something changes, longer the farther away that is.
void JerkStage::put_targets(std::vector<Place>& places, double step) const {
  double longest_jerk = 0;
  for (Eigen::Index j = 0; j < rate_.size(); ++j)
    if (std::isfinite(rate_[j])) longest_jerk = std::max(longest_jerk, 1 / rate_[j]);
  places.front().active = places.back().active = true;
  mark_bends(places);
  constexpr double growth = 0.05, longest = 20;
  double quiet = 0;
  const auto visit = [&](Place& place, double time) {
    quiet = place.active ? 0 : quiet + time;
    return step * std::clamp(1 + growth * (quiet - longest_jerk) / step, 1.0, longest);
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i].target = visit(places[i], i > 0 ? places[i].t - places[i - 1].t : 0);
  quiet = 0;
  for (std::size_t i = places.size(); i-- > 0;)
    places[i].target =
        std::min(places[i].target,
                 visit(places[i], i + 1 < places.size() ? places[i + 1].t - places[i].t : 0));
  // The joints' directions may change only a little within a cell.
  constexpr double turn = 0.05;
  std::size_t i = 0;
  for (Place& place : places) {
    while (i + 2 < stations_.size() && stations_[i + 1].x <= place.x) ++i;
    double alpha = 0, beta = 0;
    for (std::size_t j = 0; j < joints_; ++j) {
      alpha = std::max(alpha, std::abs(alpha_[i * joints_ + j]));
      beta = std::max(beta, std::abs(beta_[i * joints_ + j]));
    }
    const double rate = beta * place.v;
    if (rate * place.target > turn * alpha)
      place.target = std::max(turn * alpha / rate, std::min(place.target, step));
  }
  place_counts(places);
}

// Places around which the path alone, passed at a steady speed, takes a good part of a jerk limit.
void JerkStage::mark_bends(std::vector<Place>& places) const {
  constexpr double much = 0.05;
  std::size_t k = 0;
  for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
    const double h = stations_[i + 1].x - stations_[i].x;
    while (k + 2 < places.size() && places[k + 1].x <= stations_[i].x) ++k;
    const double v = std::max(places[k].v, places[k + 1].v);
    for (std::size_t j = 0; j < joints_; ++j) {
      const double rate = rate_[static_cast<Eigen::Index>(j)];
      const double bend = std::abs(beta_[(i + 1) * joints_ + j] - beta_[i * joints_ + j]);
      // A jump of the curvature counts over one period.
      if (bend * v * v / rate > much * std::max(h / std::max(v, 1e-300), period_)) {
        for (std::size_t p = k; p < places.size() && places[p].x <= stations_[i + 1].x; ++p)
          places[p].active = true;
        if (k + 1 < places.size()) places[k + 1].active = true;
        break;
      }
    }
  }
}

// How many cells lie before each place.
void JerkStage::place_counts(std::vector<Place>& places) {
  places.front().count = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    places[i].count = places[i - 1].count + (places[i].t - places[i - 1].t) * 2 /
                                                (places[i].target + places[i - 1].target);
}

// Nodes at even steps of a time law that is nearly the wanted one.
std::vector<double> JerkStage::mesh_on(const Law& law, double step,
                                       std::vector<double>& wanted) const {
  std::vector<Place> places;
  constexpr double hardly = 2e-3;  // share of an acceleration limit
  double steepest = 0;
  for (const double alpha : alpha_) steepest = std::max(steepest, std::abs(alpha));
  for (const LawKnot& k : law.knots) {
    places.push_back({k.x, k.v, k.t, 0, 0, std::abs(k.a) * steepest > hardly});
  }
  put_targets(places, step);
  std::size_t i = 0;
  double first = 0;  // a law that goes on begins half a cell before the first node
  if (!start_.from_rest) {
    const double t = law.node_time.front();
    while (i + 2 < places.size() && places[i + 1].t <= t) ++i;
    first = linear(t, places[i].t, places[i + 1].t, places[i].count, places[i + 1].count);
  }
  const double all = places.back().count - first;
  const double cells = std::max(std::ceil(all), 24.0);
  const double lead = start_.from_rest ? half_cell : 0;
  std::vector<double> out = {start_.x};
  for (double k = 1; k < cells; ++k) {
    const double count = first + all * (k + lead) / (cells + lead + half_cell);
    while (i + 2 < places.size() && places[i + 1].count <= count) ++i;
    const LawKnot& knot = law.knots[i];
    const double tau =
        linear(count, places[i].count, places[i + 1].count, 0, places[i + 1].t - places[i].t);
    const double x = knot.x + tau * (knot.v + tau * (knot.a / 2 + tau * knot.j / 6));
    if (!(x > out.back()) || !(x < way_end())) continue;
    out.push_back(x);
    wanted.push_back(places[i].target);
  }
  out.push_back(way_end());
  wanted.push_back(places.back().target);
  return out;
}

// q'/A by x, by cubic Hermite interpolation. `station` only grows with x.
void JerkStage::rates_at(double x, std::size_t& station, double* alpha) const {
  while (station + 2 < stations_.size() && stations_[station + 1].x <= x) ++station;
  const double h = stations_[station + 1].x - stations_[station].x;
  const double f = h > 0 ? std::clamp((x - stations_[station].x) / h, 0.0, 1.0) : 0;
  const double *a0 = &alpha_[station * joints_], *a1 = a0 + joints_;
  const double *b0 = &beta_[station * joints_], *b1 = b0 + joints_;
  for (std::size_t j = 0; j < joints_; ++j)
    alpha[j] = (1 + 2 * f) * (1 - f) * (1 - f) * a0[j] + f * f * (3 - 2 * f) * a1[j] +
               f * (1 - f) * (1 - f) * h * b0[j] - f * f * (1 - f) * h * b1[j];
}

// What comes in between two plans.
double JerkStage::window_time() const { return 5 * brake_time_ + 0.5; }

JerkStage::Plan JerkStage::solve_on(std::vector<double> x, const Plan* before, Trim trim) const {
  JerkProblem problem;
  const std::size_t n = x.size() - 1;
  problem.joints = joints_;
  problem.x = x;
  if (trim.jerk.empty()) {
    trim.jerk.assign(n + 1, jerk_room);
    trim.speed.assign(n + 1, 1.0);
  }
  problem.share = trim.jerk;
  problem.rate.assign(rate_.begin(), rate_.end());
  problem.from_rest = start_.from_rest;
  problem.b_start = start_.b;
  problem.q_before = start_.q;
  problem.time_before = start_.time;
  problem.cap.resize(n + 1);
  problem.guess.resize(n + 1);
  std::vector<double> alpha((n + 1) * joints_);
  // Rates at the nodes by cubic Hermite interpolation; caps as the least of the profile within half
  // a cell.
  std::size_t i = 0, low = 0;
  const auto profile = [&](std::size_t s, double at) {
    return linear(at, stations_[s].x, stations_[s + 1].x, stations_[s].b, stations_[s + 1].b);
  };
  for (std::size_t k = 0; k <= n; ++k) {
    rates_at(x[k], i, &alpha[k * joints_]);
    const double from = k > 0 ? (x[k - 1] + x[k]) / 2 : x[k];
    const double to = k < n ? (x[k] + x[k + 1]) / 2 : x[k];
    while (low + 2 < stations_.size() && stations_[low + 1].x <= from) ++low;
    double least = profile(low, from);
    for (std::size_t s = low; s + 1 < stations_.size() && stations_[s].x < to; ++s)
      least = std::min({least, profile(s, std::max(from, stations_[s].x)),
                        profile(s, std::min(to, stations_[s + 1].x))});
    problem.cap[k] = std::max(least, 1e-18) * trim.speed[k] * trim.speed[k];
  }
  problem.p.resize(joints_ * n);
  problem.r.resize(joints_ * n);
  for (std::size_t j = 0; j < joints_; ++j)
    for (std::size_t k = 0; k < n; ++k) {
      const double h = x[k + 1] - x[k];
      const double a0 = alpha[k * joints_ + j], a1 = alpha[(k + 1) * joints_ + j];
      const double mean = (a0 + a1) / 2 / (2 * h), bend = (a1 - a0) / h / 2;
      problem.p[j * n + k] = bend - mean;
      problem.r[j * n + k] = bend + mean;
    }
  // Where to start: the coarse plan, or a slow ride that leaves stops as the jerk allows.
  std::size_t e = 0;
  const double j0 = path_jerk(alpha.data(), rate_), j1 = path_jerk(&alpha[n * joints_], rate_);
  const auto from_stop = [](double way, double jerk) {
    if (!std::isfinite(jerk)) return infinity;
    const double v = jerk / 2 * std::pow(6 * way / jerk, 2.0 / 3);
    return v * v;
  };
  for (std::size_t k = 0; k <= n; ++k) {
    double b = 0.1 * problem.cap[k];
    if (before) {
      while (e + 2 < before->x.size() && before->x[e + 1] <= x[k]) ++e;
      b = 0.9 * linear(x[k], before->x[e], before->x[e + 1], before->b[e], before->b[e + 1]);
    }
    if (start_.from_rest) b = std::min(b, 0.2 * from_stop(x[k] - x[0], j0));
    b = std::min(b, 0.2 * from_stop(x[n] - x[k], j1));
    problem.guess[k] = std::max(b, 1e-9 * problem.cap[k]);
  }
  JerkSolution solution = solve(problem, acceleration_room);
  Plan plan;
  plan.good = solution.violation < largest_violation;
  plan.x = std::move(x);
  plan.trim = std::move(trim);
  plan.b = std::move(solution.b);
  plan.q.resize(joints_ * n);
  plan.cause.assign(n, LimitedBy::jerk);
  for (std::size_t k = 0; k < n; ++k) {
    double most = 0;
    for (std::size_t j = 0; j < joints_; ++j) {
      double& q = plan.q[j * n + k];
      q = problem.p[j * n + k] * plan.b[k] + problem.r[j * n + k] * plan.b[k + 1];
      most = std::max(most, std::abs(q));
    }
    if (most > 0.97) plan.cause[k] = LimitedBy::acceleration;
    if (plan.b[k] > 0.98 * problem.cap[k] && plan.b[k + 1] > 0.98 * problem.cap[k + 1])
      plan.cause[k] = LimitedBy::feed;  // or what limited the second-order profile: see cut()
  }
  return plan;
}

// Plans from start_ to rest at the end of the items.
void JerkStage::plan_window(bool to_stop) {
  read_stations();
  Plan plan = solve_on(Mesher(*this, 3 * period_).make(), nullptr, {});
  Law law = law_of(plan);
  for (int round = 0; round < most_meshes; ++round) {
    const Plan before = std::move(plan);
    std::vector<double> wanted;
    plan = solve_on(mesh_on(law, period_, wanted), &before, {});
    law = law_of(plan);
    if (is_fine(law.time, wanted)) break;
  }
  for (int round = 0; round < most_repairs && plan.good; ++round) {
    Trim trim = plan.trim;
    if (keeps_jerk(law, round >= first_slower_repair, trim)) break;
    const Plan before = std::move(plan);
    plan = solve_on(before.x, &before, std::move(trim));
    law = law_of(plan);
  }
  if (!plan.good && !start_.from_rest) {
    // The last plan's way to rest stays legal.
    rest_here();
    if (!items_.empty()) plan_window(to_stop);
    return;
  }
  append(plan, law, to_stop);
  hand_out(final_t_);
  next_plan_ = waiting_ + window_time();
}

// True if no cell came out much longer than it was meant to be.
bool JerkStage::is_fine(const std::vector<double>& time, const std::vector<double>& wanted) {
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] > 1.2 * wanted[k]) return false;
  return true;
}

// Looks at the joints' jerks as differences over the period see them, wherever the samples fall.
// False where a limit is passed; then the nodes around get less of the jerk limit, and of the speed
// too if `slower`.
//
// The third difference of q over T is that of the mean speed over T, the mean by Simpson's rule.
bool JerkStage::keeps_jerk(const Law& law, bool slower, Trim& trim) const {
  const std::vector<double> jerk_before = trim.jerk, speed_before = trim.speed;
  const double step = period_ / 4, begin = law.knots.front().t, end = law.knots.back().t;
  const auto count = static_cast<std::size_t>((end - begin) / step) + 17;
  const double before = start_.from_rest ? 8 * step : 0;
  std::vector<double> speed(count * joints_, 0.0);  // q' ẋ / A
  std::size_t knot = 0, station = 0;
  std::vector<double> alpha(joints_);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = begin - before + static_cast<double>(i) * step;
    if (t <= begin && start_.from_rest) continue;
    if (t >= end) continue;
    while (knot + 2 < law.knots.size() && law.knots[knot + 1].t <= t) ++knot;
    const LawKnot& k = law.knots[knot];
    const double tau = std::max(t - k.t, 0.0);
    const double x = k.x + tau * (k.v + tau * (k.a / 2 + tau * k.j / 6));
    const double v = k.v + tau * (k.a + tau * k.j / 2);
    rates_at(x, station, alpha.data());
    for (std::size_t j = 0; j < joints_; ++j) speed[i * joints_ + j] = alpha[j] * v;
  }
  const auto mean = [&](std::size_t i, std::size_t j) {
    const auto at = [&](std::size_t k) { return speed[k * joints_ + j]; };
    return (at(i - 2) + 4 * at(i - 1) + 2 * at(i) + 4 * at(i + 1) + at(i + 2)) / 12;
  };
  bool good = true;
  std::size_t low = 0;
  const double reach = 3 * period_;
  for (std::size_t i = 6; i + 6 < count; ++i) {
    double worst = 0;
    for (std::size_t j = 0; j < joints_; ++j) {
      const double rate = rate_[static_cast<Eigen::Index>(j)];
      const double jerk = (mean(i + 4, j) - 2 * mean(i, j) + mean(i - 4, j)) / (period_ * period_);
      worst = std::max(worst, std::abs(jerk) / rate);
    }
    if (worst <= seen_share) continue;
    good = false;
    const double t = begin - before + static_cast<double>(i) * step;
    while (low + 1 < law.node_time.size() && law.node_time[low] < t - reach) ++low;
    for (std::size_t k = low; k < trim.jerk.size() && law.node_time[k] <= t + reach; ++k) {
      trim.jerk[k] = std::min(trim.jerk[k], std::max(0.98 / worst, 0.5) * jerk_before[k]);
      if (slower) trim.speed[k] = 0.85 * speed_before[k];
    }
  }
  return good;
}

// The plan's time law, from the end of the final part on.
JerkStage::Law JerkStage::law_of(const Plan& plan) const {
  const std::size_t n = plan.x.size() - 1;
  Law law;
  law.time.resize(n);
  law.u.resize(n);
  law.node_time.resize(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    const double h = plan.x[k + 1] - plan.x[k];
    law.time[k] = 2 * h / (std::sqrt(plan.b[k]) + std::sqrt(plan.b[k + 1]));
    law.u[k] = (plan.b[k + 1] - plan.b[k]) / (2 * h);
  }
  LawKnot at;
  at.x = start_.x;
  if (!start_.from_rest) {
    at = state_at(final_t_);
    at.a = start_.u;
  }
  const auto go = [&](double duration, double jerk, double acceleration, LimitedBy cause) {
    if (!(duration > 0)) return;
    at.j = jerk;
    at.a = acceleration;
    at.cause = cause;
    law.knots.push_back(at);
    const double d = duration;
    at.x += d * (at.v + d * (acceleration / 2 + d * jerk / 6));
    at.v = std::max(at.v + d * (acceleration + d * jerk / 2), 0.0);
    at.t += d;
  };
  // From the middle of cell k − 1 to the middle of cell k, over the ramp at node k.
  for (std::size_t k = 0; k <= n; ++k) {
    const double before = k > 0 ? law.time[k - 1] : start_.from_rest ? 0 : start_.time;
    const double after = k < n ? law.time[k] : 0;
    const double u0 = k > 0 ? law.u[k - 1] : start_.from_rest ? 0 : start_.u;
    const double u1 = k < n ? law.u[k] : 0;
    const bool edge = !(before > 0) || !(after > 0);
    const double ramp = edge ? before + after : std::min(before, after);
    const LimitedBy left = plan.cause[k > 0 ? k - 1 : 0], right = plan.cause[k < n ? k : n - 1];
    if (!edge) go((before - ramp) / 2, 0, u0, left);
    law.node_time[k] = at.t + ramp / 2;
    go(ramp, (u1 - u0) / ramp, u0, left);
    if (!edge) go((after - ramp) / 2, 0, u1, right);
  }
  take_drift_back(law.knots, plan.x.back() - at.x, -at.v, at.t);
  law.knots.push_back({at.t, plan.x.back(), 0, 0, 0, LimitedBy::none});
  return law;
}

// Smoothing moves the way's end by less than a micrometre. From rest all is scaled; on the move, an
// acceleration A + J t is added that ends with the wanted way and speed.
void JerkStage::take_drift_back(std::vector<LawKnot>& knots, double way, double speed,
                                double t_end) const {
  const LawKnot first = knots.front();
  if (start_.from_rest) {
    const double scale = 1 + way / (way_end() - way - first.x);
    for (LawKnot& k : knots) {
      k.x = first.x + scale * (k.x - first.x);
      k.v *= scale;
      k.a *= scale;
      k.j *= scale;
    }
    return;
  }
  const double whole = t_end - first.t;
  const double j = 12 * (speed * whole / 2 - way) / (whole * whole * whole);
  const double a = speed / whole - j * whole / 2;
  for (LawKnot& k : knots) {
    const double t = k.t - first.t;
    k.x += t * t * (a / 2 + t * j / 6);
    k.v += t * (a + t * j / 2);
    k.a += a + t * j;
    k.j += j;
  }
}

// Appends a plan's law behind what is final, and says how much more is.
void JerkStage::append(const Plan& plan, const Law& law, bool to_stop) {
  const std::size_t n = plan.x.size() - 1;
  law_end_ = law.knots.back().t;
  rest_x_ = plan.x.back();
  // How much is final: all, or up to the node behind which two brakings fit.
  std::size_t last = n;
  if (!to_stop) {
    while (last > 1 && law_end_ - law.node_time[last] < 2 * brake_time_) --last;
    if (last == 1) last = 0;
  }
  if (start_.from_rest) {
    law_.clear();
  } else {
    const std::size_t i = knot_at(final_t_);
    law_.resize(law_[i].t < final_t_ ? i + 1 : i);
  }
  law_.insert(law_.end(), law.knots.begin(), law.knots.end());
  if (last == n) {
    final_t_ = law_end_;
  } else if (last > 0) {
    final_t_ = law.node_time[last] - law.time[last - 1] / 2;
    start_ = {};
    start_.from_rest = false;
    start_.x = plan.x[last];
    start_.b = plan.b[last];
    start_.time = law.time[last - 1];
    start_.u = law.u[last - 1];
    for (std::size_t j = 0; j < joints_; ++j) start_.q.push_back(plan.q[j * n + last - 1]);
  }
}

JerkStage::LawKnot JerkStage::state_at(double t) const {
  LawKnot k = law_[knot_at(t)];
  const double tau = t - k.t;
  k.t = t;
  k.x += tau * (k.v + tau * (k.a / 2 + tau * k.j / 6));
  k.v += tau * (k.a + tau * k.j / 2);
  k.a += tau * k.j;
  return k;
}

std::size_t JerkStage::knot_at(double t) const {
  const auto after = std::upper_bound(law_.begin(), law_.end(), t,
                                      [](double time, const LawKnot& k) { return time < k.t; });
  return after == law_.begin() ? 0 : static_cast<std::size_t>(after - law_.begin() - 1);
}

// When the law passes x.
double JerkStage::time_at(double x) const {
  const auto after = std::upper_bound(law_.begin(), law_.end(), x,
                                      [](double way, const LawKnot& k) { return way < k.x; });
  if (after == law_.begin()) return law_.front().t;
  if (after == law_.end()) return law_.back().t;
  const LawKnot& k = *(after - 1);
  double low = 0, high = after->t - k.t, tau = high / 2;
  for (int i = 0; i < 60; ++i) {
    const double miss = k.x + tau * (k.v + tau * (k.a / 2 + tau * k.j / 6)) - x;
    (miss > 0 ? high : low) = tau;
    if (!(high - low > 1e-15 * after->t)) break;
    const double slope = k.v + tau * (k.a + tau * k.j / 2);
    const double newton = tau - miss / slope;
    const bool inside = newton > low && newton < high;
    const double next = inside ? newton : (low + high) / 2;
    if (inside && std::abs(next - tau) < 1e-16 + 1e-15 * after->t) break;
    tau = next;
  }
  return k.t + tau;
}

Segment JerkStage::cut(Item& item, double t0, double t1) const {
  Segment out = std::move(item.segment);
  const LimitedBy second_order = out.limited_by;
  SpeedProfile profile;
  std::array<double, 5> spent{};
  const double f = item.stretch;
  for (std::size_t i = knot_at(t0); i + 1 < law_.size() && law_[i].t < t1; ++i) {
    const LawKnot& k = law_[i];
    const double begin = std::max(t0, k.t), end = std::min(t1, law_[i + 1].t);
    if (!(end > begin)) continue;
    const double tau = begin - k.t;
    const double x = k.x + tau * (k.v + tau * (k.a / 2 + tau * k.j / 6));
    const double v = k.v + tau * (k.a + tau * k.j / 2);
    const double s = profile.knots.empty() ? 0 : std::max((x - item.begin) / f, 0.0);
    profile.knots.push_back({begin - t0, std::min(s, item.grid.length()), std::max(v, 0.0) / f,
                             (k.a + tau * k.j) / f, k.j / f});
    const LimitedBy cause =
        k.cause == LimitedBy::feed && second_order != LimitedBy::none ? second_order : k.cause;
    spent[static_cast<std::size_t>(cause)] += end - begin;
  }
  const LawKnot& k = law_[knot_at(t1)];
  const double tau = t1 - k.t;
  const double v = std::max(k.v + tau * (k.a + tau * k.j / 2), 0.0);
  profile.knots.push_back({t1 - t0, item.grid.length(), v / f, (k.a + tau * k.j) / f, 0});
  out.limited_by =
      static_cast<LimitedBy>(std::max_element(spent.begin(), spent.end()) - spent.begin());
  out.profile = std::move(profile);
  return out;
}

// Pieces that end within the final part of the law go out.
void JerkStage::hand_out(double t_final) {
  while (!items_.empty() && !law_.empty()) {
    Item& item = items_.front();
    const bool at_rest = t_final >= law_end_ && item.end() >= rest_x_;
    if (item.end() > rest_x_) break;
    const double t1 = at_rest ? law_end_ : time_at(item.end());
    if (t1 > t_final) break;
    waiting_ -= item.segment.duration();
    ready_.push_back(cut(item, cut_t_, t1));
    for (Segment& still : item.after) ready_.push_back(std::move(still));
    items_.pop_front();
    cut_t_ = t1;
  }
  if (items_.empty()) waiting_ = 0;
  // Forget the law before the cut.
  if (law_.size() > 1) {
    const std::size_t i = knot_at(cut_t_);
    law_.erase(law_.begin(), law_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace aircut::plan
