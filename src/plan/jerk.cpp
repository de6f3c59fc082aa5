// From the second-order profile to one with limited jerk.
//
// Between two stops all pieces are laid on one way x. The second-order profile b₂(x) is the largest
// squared speed that any ride can have there, so it is the cap of the third-order one. Over it go
// nodes, about one per period of the log (jerk_mesh.h); the solver (jerk_solver.h) finds the
// squared speeds b at them, and a law x(t) of cubics follows (jerk_window.h).
//
//   windows  The way is planned to a stop at the end of what has come so far; all but the last
//            braking is final. The next window starts from the last final cell. The plan to that
//            stop is kept: should a window not come out legal, it is carried out.
//   proof    A law is taken only when the samples that the log will hold keep the limits
//            (jerk_check.h). Where they don't, the nodes around get less, and the window is solved
//            again. What is still too much then starts at rest, and is carried out in f times the
//            time: accelerations are divided by f², jerks by f³, so some f is enough.
//
// A stretch on which all joints run straight with one limit has the closed form (s_curve.h).
#include "plan/jerk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/jerk_mesh.h"
#include "plan/s_curve.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_meshes = 3;
constexpr int most_repairs = 16;
constexpr int first_slower_repair = 7;

}  // namespace

JerkStage::JerkStage(const machine::Kinematics& kinematics, const JointLimits& limits,
                     machine::JointVector start, double period)
    : limits_(limits), samples_(kinematics, limits_, std::move(start), period) {
  window_.joints = static_cast<std::size_t>(limits.a.size());
  window_.rate = limits.j.cwiseQuotient(limits.a);
  window_.period = period;
  for (Eigen::Index j = 0; j < limits.a.size(); ++j) {
    const double ramp = std::isfinite(window_.rate[j]) ? 1 / window_.rate[j] : 0;
    window_.brake_time = std::max(window_.brake_time, limits.v[j] / limits.a[j] + ramp);
    ramp_time_ = std::max(ramp_time_, ramp);
  }
  next_plan_ = window_time();
}

// What comes in between two plans.
double JerkStage::window_time() const { return 10 * window_.brake_time + 1; }

void JerkStage::push(Segment segment, Grid grid, double scale) {
  WayItem item;
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
    give(std::move(segment));
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
  window_.start = {};
  problem_.clear();
  straight_ = items_.empty();
  final_t_ = law_end_ = cut_t_ = 0;
  next_plan_ = window_time();
  double begin = 0;
  for (WayItem& item : items_) {
    item.begin = begin;
    begin = item.end();
  }
}

// True if the joints run on as in the first piece, with the same limits.
bool JerkStage::goes_on_straight(const WayItem& item) const {
  const WayItem& first = items_.front();
  if (!first.grid.uniform || !item.grid.uniform) return false;
  const machine::JointVector dq = first.grid.dq_start / first.stretch;
  const double cap = first.grid.at.front().cap * first.stretch * first.stretch;
  const double here = item.grid.at.front().cap * item.stretch * item.stretch;
  if (std::abs(here - cap) > 1e-9 * cap && here != cap) return false;
  return (item.grid.dq_start / item.stretch - dq).norm() <= 1e-9 * dq.norm();
}

void JerkStage::plan_straight() {
  const WayItem& first = items_.front();
  const machine::JointVector alpha = first.grid.dq_start.cwiseQuotient(limits_.a) / first.stretch;
  StraightLimits limits{};
  limits.v = std::sqrt(first.grid.at.front().cap) * first.stretch;
  limits.a = 1 / alpha.cwiseAbs().maxCoeff();
  limits.j = path_jerk(alpha.data(), window_.rate);
  if (!std::isfinite(limits.j)) {
    // No joint that moves has a jerk limit: the second-order profile stays.
    for (WayItem& item : items_) {
      give(std::move(item.segment));
      for (Segment& still : item.after) give(std::move(still));
    }
    items_.clear();
    waiting_ = 0;
    return;
  }
  Eigen::Index jerk_limited = 0;
  alpha.cwiseQuotient(window_.rate).cwiseAbs().maxCoeff(&jerk_limited);
  const auto jerk_joint = static_cast<signed char>(jerk_limited);
  const SpeedProfile profile = s_curve(way_end(), limits);
  std::vector<LawKnot> law;
  for (const ProfileKnot& k : profile.knots) {
    Cause cause{LimitedBy::jerk, jerk_joint};
    if (k.j == 0 && k.a != 0) cause = {LimitedBy::acceleration, first.grid.uniform_joint};
    if (k.j == 0 && k.a == 0) cause = first.grid.at.front().why;
    law.push_back({k.t, k.s, k.v, k.a, k.j, cause});
  }
  // The closed form keeps the limits; what is left to look at is the samples that it shares with
  // the end of the motion before.
  slow_down(law, slowness(law, 4 * window_.period));
  carry_out(std::move(law));
}

void JerkStage::read_stations() {
  JerkWindow& w = window_;
  w.stations.clear();
  w.alpha.clear();
  w.beta.clear();
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const WayItem& item = items_[i];
    if (item.end() <= w.start.x && i + 1 < items_.size()) continue;
    const double f = item.stretch;
    const auto& knots = item.segment.profile.knots;
    for (std::size_t k = 0; k < knots.size(); ++k) {
      w.stations.push_back({k + 1 == knots.size() ? item.end() : item.begin + f * knots[k].s,
                            f * f * knots[k].v * knots[k].v});
      for (std::size_t j = 0; j < w.joints; ++j) {
        const auto row = static_cast<Eigen::Index>(j);
        w.alpha.push_back(
            (item.grid.uniform ? item.grid.dq_start[row] / limits_.a[row] : item.grid.alpha(k)[j]) /
            f);
        w.beta.push_back(item.grid.uniform ? 0 : item.grid.beta(k)[j] / (f * f));
      }
    }
  }
}

NodePlan JerkStage::solved(std::vector<double> x, const NodePlan* before, Trim trim) {
  NodePlan plan = solve_on(window_, std::move(x), before, std::move(trim));
  newton_steps_ += plan.steps;
  return plan;
}

WindowLaw JerkStage::law_of_plan(const NodePlan& plan) const {
  return law_of(window_, plan, window_.start.from_rest ? LawKnot{} : state_at(law_, final_t_));
}

std::vector<Excess> JerkStage::logged_excess(const std::vector<LawKnot>& law, double until) const {
  static const std::vector<LawKnot> at_rest;
  return samples_.excess({items_, window_.start.from_rest ? at_rest : law_, law, clock_, cut_t_},
                         until);
}

// Solves the window again with less where too much is seen. False if that does not end.
bool JerkStage::keep_limits(NodePlan& plan, WindowLaw& law) {
  for (int round = 0; plan.good; ++round) {
    std::vector<Excess> excess = jerk_excess(window_, law);
    if (excess.empty()) excess = logged_excess(law.knots, infinity);
    if (excess.empty()) return true;
    if (round == most_repairs) return false;
    Trim trim = plan.trim;
    trim_around(excess, window_, plan, law, round >= first_slower_repair, trim);
    const NodePlan before = std::move(plan);
    plan = solved(before.x, &before, std::move(trim));
    if (plan.good) law = law_of_plan(plan);
  }
  return false;
}

// How many times the time a law from rest needs so that the samples keep the limits. Notes a
// problem if there is no answer.
double JerkStage::slowness(std::vector<LawKnot> law, double until) {
  constexpr int most_rounds = 60, first_careful = 4;
  double whole = 1;
  for (int round = 0; round < most_rounds; ++round) {
    double worst = 0;
    for (const Excess& e : logged_excess(law, until)) worst = std::max(worst, e.share);
    if (worst == 0) return whole;
    // A kink of the path is a jump of speed: it counts with the factor itself.
    double factor = round < first_careful ? std::cbrt(worst) : worst;
    factor = std::min(1.0003 * factor, 4.0);
    slow_down(law, factor);
    whole *= factor;
  }
  problem_ = "no time law was found here that keeps the acceleration and jerk limits of all joints";
  return whole;
}

// For a window that can't be solved: the closed form of a straight way under the least limits that
// there are anywhere, slowed down until the joints keep theirs.
void JerkStage::go_gently() {
  const JerkWindow& w = window_;
  StraightLimits limits{infinity, infinity, infinity};
  for (const WayItem& item : items_)
    for (const GridNode& node : item.grid.at)
      limits.v = std::min(limits.v, item.stretch * std::sqrt(node.cap));
  for (std::size_t k = 0; k < w.stations.size(); ++k) {
    const double* alpha = &w.alpha[k * w.joints];
    for (std::size_t j = 0; j < w.joints; ++j)
      if (alpha[j] != 0) limits.a = std::min(limits.a, 1 / std::abs(alpha[j]));
    limits.j = std::min(limits.j, path_jerk(alpha, w.rate));
  }
  std::vector<LawKnot> law;
  for (const ProfileKnot& k : s_curve(way_end(), limits).knots)
    law.push_back({k.t, k.s, k.v, k.a, k.j, {LimitedBy::jerk, -1}});
  slow_down(law, slowness(law, infinity));
  carry_out(std::move(law));
  rest_here();
}

// Plans from the window's start to rest at the end of the items.
void JerkStage::plan_window(bool to_stop) {
  read_stations();
  const double period = window_.period;
  ++windows_;
  NodePlan plan = solved(first_mesh(window_, 3 * period), nullptr, {});
  WindowLaw law = law_of_plan(plan);
  for (int round = 0; round < most_meshes; ++round) {
    const NodePlan before = std::move(plan);
    std::vector<double> wanted;
    plan = solved(mesh_on(window_, law, period, wanted), &before, {});
    law = law_of_plan(plan);
    if (is_fine(law.time, wanted)) break;
  }
  if (!keep_limits(plan, law)) {
    if (!window_.start.from_rest) {
      // The last plan's way to rest stays legal.
      rest_here();
      if (!items_.empty()) plan_window(to_stop);
      return;
    }
    if (!plan.good) return go_gently();
    slow_down(plan, law, slowness(law.knots, infinity));
  }
  append(plan, law, to_stop);
  hand_out(final_t_);
  next_plan_ = waiting_ + window_time();
}

// A law from rest to rest at the end of the items.
void JerkStage::carry_out(std::vector<LawKnot> law) {
  law_ = std::move(law);
  final_t_ = law_end_ = law_.back().t;
  rest_x_ = way_end();
}

// Appends a plan's law behind what is final, and says how much more is.
void JerkStage::append(const NodePlan& plan, const WindowLaw& law, bool to_stop) {
  const std::size_t n = plan.x.size() - 1;
  WindowStart& start = window_.start;
  law_end_ = law.knots.back().t;
  rest_x_ = plan.x.back();
  // How much is final: all, or up to the node behind which two brakings fit.
  std::size_t last = n;
  if (!to_stop) {
    while (last > 1 && law_end_ - law.node_time[last] < 2 * window_.brake_time) --last;
    if (last == 1) last = 0;
  }
  if (start.from_rest) {
    law_.clear();
  } else {
    const std::size_t i = knot_at(law_, final_t_);
    law_.resize(law_[i].t < final_t_ ? i + 1 : i);
  }
  law_.insert(law_.end(), law.knots.begin(), law.knots.end());
  if (last == n) {
    final_t_ = law_end_;
  } else if (last > 0) {
    final_t_ = law.node_time[last] - law.time[last - 1] / 2;
    start = {};
    start.from_rest = false;
    start.x = plan.x[last];
    start.b = plan.b[last];
    start.time = law.time[last - 1];
    start.u = law.u[last - 1];
    // Right behind the start there is no way back: the next window keeps these nodes and what was
    // learnt there, so the plan so far stays one that it could choose.
    constexpr std::size_t most_known = 40;
    for (std::size_t k = last; k < std::min(last + most_known, n); ++k) {
      start.known_x.push_back(plan.x[k]);
      start.known.jerk.push_back(plan.trim.jerk[k]);
      start.known.speed.push_back(plan.trim.speed[k]);
    }
    const auto from = static_cast<std::ptrdiff_t>(last);
    start.rest_x.assign(plan.x.begin() + from, plan.x.end());
    start.rest_b.assign(plan.b.begin() + from, plan.b.end());
    for (std::size_t j = 0; j < window_.joints; ++j) start.q.push_back(plan.q[j * n + last - 1]);
  }
}

void JerkStage::give(Segment segment) {
  samples_.pass(segment, clock_);
  clock_ += segment.duration();
  ready_.push_back(std::move(segment));
}

Segment JerkStage::cut(WayItem& item, double t0, double t1) {
  Segment out = std::move(item.segment);
  const Cause second_order = out.limited_by;
  SpeedProfile profile;
  CauseTimes spent;
  const double f = item.stretch;
  for (std::size_t i = knot_at(law_, t0); i + 1 < law_.size() && law_[i].t < t1; ++i) {
    const LawKnot& k = law_[i];
    const double begin = std::max(t0, k.t), end = std::min(t1, law_[i + 1].t);
    if (!(end > begin)) continue;
    const double tau = begin - k.t;
    const double x = k.way(tau);
    const double v = k.speed(tau);
    const double s = profile.knots.empty() ? 0 : std::max((x - item.begin) / f, 0.0);
    profile.knots.push_back({begin - t0, std::min(s, item.grid.length()), std::max(v, 0.0) / f,
                             (k.a + tau * k.j) / f, k.j / f});
    const bool capped = k.cause.by == LimitedBy::feed && second_order.by != LimitedBy::none;
    spent.add(capped ? second_order : k.cause, end - begin);
  }
  const LawKnot& k = law_[knot_at(law_, t1)];
  const double tau = t1 - k.t;
  const double v = std::max(k.speed(tau), 0.0);
  profile.knots.push_back({t1 - t0, item.grid.length(), v / f, (k.a + tau * k.j) / f, 0});
  out.limited_by = spent.longest();
  out.profile = std::move(profile);
  out.limit_problem = std::exchange(problem_, {});
  return out;
}

// Pieces that end within the final part of the law go out.
void JerkStage::hand_out(double t_final) {
  while (!items_.empty() && !law_.empty()) {
    WayItem& item = items_.front();
    const bool at_rest = t_final >= law_end_ && item.end() >= rest_x_;
    if (item.end() > rest_x_) break;
    const double t1 = at_rest ? law_end_ : time_at(law_, item.end());
    if (t1 > t_final) break;
    waiting_ -= item.segment.duration();
    give(cut(item, cut_t_, t1));
    for (Segment& still : item.after) give(std::move(still));
    items_.pop_front();
    cut_t_ = t1;
  }
  if (items_.empty()) waiting_ = 0;
  // Forget the law before the cut.
  if (law_.size() > 1) {
    const std::size_t i = knot_at(law_, cut_t_);
    law_.erase(law_.begin(), law_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace aircut::plan
