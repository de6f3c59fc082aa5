// A window's rows for the solver, and the solver's answer as a plan.
//
//   rows   What counts in a cell is the mean acceleration of each joint, the change of its speed
//          q' v over the time. With the mean α of q'/A at the ends and β = Δ(q'/A) / h it is
//          α u + β b, exact for the cell as a whole. So a cell may span many tiny pieces.
//   caps   The second-order profile b₂ is the largest squared speed that any ride can have at a
//          place: feed, joint speeds and curvature need not be looked at again.
#include "plan/jerk_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/jerk_solver.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double acceleration_room = 0.998;
constexpr double jerk_room = 0.982;
constexpr double largest_violation = 2e-3;

// All of the limits but a room; less where the last plan had to do with less.
Trim first_trim(const WindowStart& start, const std::vector<double>& x) {
  Trim out{std::vector<double>(x.size(), jerk_room), std::vector<double>(x.size(), 1.0)};
  for (std::size_t k = 0; k < start.known_x.size() && k < x.size() && x[k] == start.known_x[k];
       ++k) {
    out.jerk[k] = start.known.jerk[k];
    out.speed[k] = start.known.speed[k];
  }
  return out;
}

// b of a plan at x. Next to a stop b goes with x^(4/3).
double speed_of(const NodePlan& plan, double x, std::size_t& cell) {
  const std::size_t last = plan.x.size() - 2;
  while (cell < last && plan.x[cell + 1] <= x) ++cell;
  const double x0 = plan.x[cell], x1 = plan.x[cell + 1], b0 = plan.b[cell], b1 = plan.b[cell + 1];
  const double f = std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
  if (b0 == 0) return b1 * std::pow(f, 4.0 / 3);
  if (b1 == 0) return b0 * std::pow(1 - f, 4.0 / 3);
  return b0 + f * (b1 - b0);
}

// Where the solver starts: a plan that is nearly it, a little slower; without one, a slow ride that
// leaves stops as the jerk allows. Behind a start on the move that is first the way to rest of the
// window before, which is legal.
std::vector<double> first_guess(const JerkWindow& w, const JerkProblem& problem,
                                const NodePlan* before, double start_jerk, double end_jerk) {
  const std::vector<double>& x = problem.x;
  const std::size_t n = x.size() - 1;
  const auto from_stop = [](double way, double jerk) {
    if (!std::isfinite(jerk)) return infinity;
    const double v = jerk / 2 * std::pow(6 * way / jerk, 2.0 / 3);
    return v * v;
  };
  const WindowStart& start = w.start;
  constexpr double slower = 0.1, cells_to_slow = 30;
  std::vector<double> out(n + 1);
  std::size_t cell = 0;
  for (std::size_t k = 0; k <= n; ++k) {
    double b = slower * problem.cap[k];
    if (before) {
      const double part =
          start.from_rest ? 1 : std::min(static_cast<double>(k) / cells_to_slow, 1.0);
      b = (1 - slower * part * part) * speed_of(*before, x[k], cell);
    } else {
      if (start.from_rest) b = std::min(b, 0.2 * from_stop(x[k] - x[0], start_jerk));
      b = std::min(b, 0.2 * from_stop(x[n] - x[k], end_jerk));
      if (!start.from_rest && x[k] < start.rest_x.back()) {
        while (cell + 2 < start.rest_x.size() && start.rest_x[cell + 1] <= x[k]) ++cell;
        b = std::max(b, linear(x[k], start.rest_x[cell], start.rest_x[cell + 1], start.rest_b[cell],
                               start.rest_b[cell + 1]));
      }
    }
    out[k] = std::max(b, 1e-9 * problem.cap[k]);
  }
  return out;
}

}  // namespace

double path_jerk(const double* alpha, const machine::JointVector& rate) {
  double least = infinity;
  for (Eigen::Index j = 0; j < rate.size(); ++j)
    if (alpha[j] != 0) least = std::min(least, rate[j] / std::abs(alpha[j]));
  return least;
}

double linear(double x, double x0, double x1, double y0, double y1) {
  return x1 > x0 ? y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0) : y0;
}

void JerkWindow::rates_at(double x, std::size_t& station, double* out) const {
  while (station + 2 < stations.size() && stations[station + 1].x <= x) ++station;
  const double h = stations[station + 1].x - stations[station].x;
  const double f = h > 0 ? std::clamp((x - stations[station].x) / h, 0.0, 1.0) : 0;
  const double *a0 = &alpha[station * joints], *a1 = a0 + joints;
  const double *b0 = &beta[station * joints], *b1 = b0 + joints;
  for (std::size_t j = 0; j < joints; ++j)
    out[j] = (1 + 2 * f) * (1 - f) * (1 - f) * a0[j] + f * f * (3 - 2 * f) * a1[j] +
             f * (1 - f) * (1 - f) * h * b0[j] - f * f * (1 - f) * h * b1[j];
}

NodePlan solve_on(const JerkWindow& w, std::vector<double> x, const NodePlan* before, Trim trim) {
  JerkProblem problem;
  const std::size_t n = x.size() - 1;
  problem.joints = w.joints;
  problem.x = x;
  if (trim.jerk.empty()) {
    trim = first_trim(w.start, x);
  }
  problem.share = trim.jerk;
  problem.rate.assign(w.rate.begin(), w.rate.end());
  problem.from_rest = w.start.from_rest;
  problem.b_start = w.start.b;
  problem.q_before = w.start.q;
  problem.time_before = w.start.time;
  problem.cap.resize(n + 1);
  std::vector<double> alpha((n + 1) * w.joints);
  // Rates at the nodes by cubic Hermite interpolation; caps as the least of the profile within half
  // a cell.
  std::size_t i = 0, low = 0;
  const auto profile = [&](std::size_t s, double at) {
    return linear(at, w.stations[s].x, w.stations[s + 1].x, w.stations[s].b, w.stations[s + 1].b);
  };
  for (std::size_t k = 0; k <= n; ++k) {
    w.rates_at(x[k], i, &alpha[k * w.joints]);
    const double from = k > 0 ? (x[k - 1] + x[k]) / 2 : x[k];
    const double to = k < n ? (x[k] + x[k + 1]) / 2 : x[k];
    while (low + 2 < w.stations.size() && w.stations[low + 1].x <= from) ++low;
    double least = profile(low, from);
    for (std::size_t s = low; s + 1 < w.stations.size() && w.stations[s].x < to; ++s)
      least = std::min({least, profile(s, std::max(from, w.stations[s].x)),
                        profile(s, std::min(to, w.stations[s + 1].x))});
    problem.cap[k] = std::max(least, 1e-18) * trim.speed[k] * trim.speed[k];
  }
  problem.p.resize(w.joints * n);
  problem.r.resize(w.joints * n);
  for (std::size_t j = 0; j < w.joints; ++j)
    for (std::size_t k = 0; k < n; ++k) {
      const double h = x[k + 1] - x[k];
      const double a0 = alpha[k * w.joints + j], a1 = alpha[(k + 1) * w.joints + j];
      const double mean = (a0 + a1) / 2 / (2 * h), bend = (a1 - a0) / h / 2;
      problem.p[j * n + k] = bend - mean;
      problem.r[j * n + k] = bend + mean;
    }
  problem.guess = first_guess(w, problem, before, path_jerk(alpha.data(), w.rate),
                              path_jerk(&alpha[n * w.joints], w.rate));
  JerkSolution solution = solve(problem, acceleration_room);
  NodePlan plan;
  plan.good = solution.violation < largest_violation;
  plan.steps = static_cast<std::uint64_t>(solution.rounds);
  plan.x = std::move(x);
  plan.trim = std::move(trim);
  plan.b = std::move(solution.b);
  plan.q.resize(w.joints * n);
  plan.cause.assign(n, {LimitedBy::jerk, -1});
  for (std::size_t k = 0; k < n; ++k) {
    double most = 0, steepest = 0;
    Cause acceleration{LimitedBy::acceleration, -1};
    for (std::size_t j = 0; j < w.joints; ++j) {
      double& q = plan.q[j * n + k];
      q = problem.p[j * n + k] * plan.b[k] + problem.r[j * n + k] * plan.b[k + 1];
      if (std::abs(q) > most) {
        most = std::abs(q);
        acceleration.joint = static_cast<signed char>(j);
      }
      const double change = std::abs(q - (k > 0 ? plan.q[j * n + k - 1] : 0)) / problem.rate[j];
      if (change > steepest) {
        steepest = change;
        plan.cause[k].joint = static_cast<signed char>(j);
      }
    }
    if (most > 0.97) plan.cause[k] = acceleration;
    if (plan.b[k] > 0.98 * problem.cap[k] && plan.b[k + 1] > 0.98 * problem.cap[k + 1])
      plan.cause[k] = {LimitedBy::feed, -1};  // or what limited the second-order profile: see cut()
  }
  plan.cap = std::move(problem.cap);
  return plan;
}

}  // namespace aircut::plan
