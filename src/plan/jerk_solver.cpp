// The fastest ride under jerk limits, by an interior-point method.
//
//   least  Σ τ_k,  τ_k = 2 h_k / (√b_k + √b_{k+1})                       time of a cell
//   with   b_k ≤ cap_k,   |Q_k| ≤ 1,   |Q_k − Q_{k−1}| ≤ G (τ_{k−1} + τ_k) / 2
//
// Q_k is linear in b, the time law in between is a constant path acceleration. The last row is the
// jerk limit in its time-integrated form: how much the joint's acceleration may change from the
// middle of one cell to the middle of the next. (In the pointwise form J / √b a solver gains time
// by letting single nodes fall to rest.) At rest Q_{−1} = Q_N = 0 and the change has the time of
// one cell: the time law is smoothed later so that it starts and ends half a cell outside.
//
// τ is convex, so the objective is; the jerk rows have a convex right side, and its tangent lies
// below it: linearised rows are stricter than the true ones. Each round is one Newton step of the
// primal-dual method on the linearised rows. With slacks s and multipliers λ of rows c(b) + s = 0:
//
//   (∇²Στ + Σ λ/s a aᵀ) Δb = −∇Στ − Σ a (μ + λ (c + s)) / s,     a = ∇c
//
// All rows touch three neighbouring nodes, so the matrix has five diagonals and a round costs
// O(nodes · joints). Nearly all of that is the rows' part, which jerk_rows.h does in vectors.
#include "plan/jerk_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/five_diagonals.h"
#include "plan/jerk_rows.h"

namespace aircut::plan {
namespace {

using Vector = std::vector<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_rounds = 80;
constexpr double relative_gap = 1e-4;
constexpr double small_violation = 1e-7;

const RowKernels& kernels() {
  static const RowKernels* const fast = avx2_row_kernels();
  return fast ? *fast : portable_row_kernels();
}

class Solver {
 public:
  Solver(const JerkProblem& problem, double acceleration_room);
  JerkSolution run();

 private:
  struct Joint {
    CellRates cells{};
    Rows acceleration{}, jerk{};
    bool has_jerk = false;
  };

  double* places();
  Rows rows(std::size_t count, double limit);
  void add_joint(std::size_t j);
  void times();
  void move(double primal, double dual, double least);
  void assemble(double mu);
  void add_times();
  void add_caps(double mu);
  void add_rows(double mu);
  void directions(double mu);

  const JerkProblem& problem_;
  std::size_t n_;  ///< cells
  double room_;    ///< of acceleration
  const RowKernels& kernels_ = kernels();
  std::size_t stride_;  ///< of the arrays in store_
  Vector store_;
  std::size_t used_ = 0;  ///< of store_
  std::vector<Joint> joints_;
  NodeValues nodes_{};
  RowSums sums_{};
  Vector cap_, h_;
  /// By node √b and 1/√b, the latter 0 where b is fixed; by cell 1 / (√b_k + √b_{k+1}), τ and its
  /// derivatives by the two ends.
  Vector v_, over_v_, over_sum_, tau_, left_, right_;
  double objective_ = 0, product_ = 0, violation_ = 0;
  std::size_t count_ = 0;  ///< rows
  Vector cap_slack_, cap_multiplier_, cap_slack_step_, cap_multiplier_step_;
  FiveDiagonals matrix_;
  Vector step_;
  double primal_step_ = 1, dual_step_ = 1;
};

constexpr std::size_t arrays_of_joint = 3 + 2 * 8, arrays_of_nodes = 6 + 9;

Solver::Solver(const JerkProblem& problem, double acceleration_room)
    : problem_(problem),
      n_(problem.cells()),
      room_(acceleration_room),
      stride_(n_ + 1 + 3 * row_lanes),
      store_(stride_ * (problem.joints * arrays_of_joint + arrays_of_nodes)),
      cap_(problem.cap) {
  const std::size_t nodes = n_ + 1;
  for (double** v : {&nodes_.b, &nodes_.step, &nodes_.time, &nodes_.t0, &nodes_.t1, &nodes_.t2})
    *v = places();
  for (double*& v : sums_.of) v = places();
  for (std::size_t j = 0; j < problem.joints; ++j) add_joint(j);
  for (Vector* v : {&h_, &over_sum_, &tau_, &left_, &right_}) v->assign(n_, 0);
  for (Vector* v :
       {&v_, &over_v_, &cap_slack_, &cap_multiplier_, &cap_slack_step_, &cap_multiplier_step_})
    v->assign(nodes, 0);
  for (std::size_t k = 0; k < n_; ++k) h_[k] = problem.x[k + 1] - problem.x[k];
  for (std::size_t k = 1; k < n_; ++k) nodes_.b[k] = std::min(problem.guess[k], 0.9 * cap_[k]);
  nodes_.b[0] = problem.from_rest ? 0 : problem.b_start;
  // No rows, but the loops look at them: a limit that is never reached.
  constexpr double never = 1e6;
  std::fill_n(nodes_.time + nodes, row_lanes, never);
  count_ += n_ - 1;
}

double* Solver::places() {
  double* out = store_.data() + used_ + row_lanes;
  used_ += stride_;
  return out;
}

Rows Solver::rows(std::size_t count, double limit) {
  Rows out{};
  out.count = count;
  out.limit = limit;
  for (auto* sides : {&out.s, &out.m, &out.ds, &out.dm})
    for (double*& v : *sides) v = places();
  count_ += 2 * count;
  return out;
}

// A joint that does not move in this window has no rows.
void Solver::add_joint(std::size_t j) {
  const double *p = &problem_.p[j * n_], *r = &problem_.r[j * n_];
  const double before = problem_.from_rest ? 0 : problem_.q_before[j];
  double size = std::abs(before);
  for (std::size_t k = 0; k < n_; ++k) size = std::max({size, std::abs(p[k]), std::abs(r[k])});
  if (!(size > 0)) return;
  Joint out;
  out.cells = {places(), places(), places()};
  std::copy_n(p, n_, out.cells.p);
  std::copy_n(r, n_, out.cells.r);
  out.cells.q[-1] = before;
  out.acceleration = rows(n_, room_);
  out.has_jerk = std::isfinite(problem_.rate[j]);
  if (out.has_jerk) out.jerk = rows(n_ + 1, problem_.rate[j]);
  joints_.push_back(out);
}

// Times of the cells and of the jerk rows with their derivatives. Fixed ends have none.
void Solver::times() {
  objective_ = 0;
  for (std::size_t k = 0; k <= n_; ++k) v_[k] = std::sqrt(nodes_.b[k]);
  for (std::size_t k = 1; k < n_; ++k) over_v_[k] = 1 / v_[k];
  for (std::size_t k = 0; k < n_; ++k) {
    const double over = 1 / (v_[k] + v_[k + 1]), part = h_[k] * over * over;
    over_sum_[k] = over;
    tau_[k] = 2 * h_[k] * over;
    left_[k] = -part * over_v_[k];
    right_[k] = -part * over_v_[k + 1];
    objective_ += tau_[k];
  }
  // The share of the limit goes into the time that a row counts. At a rest it is that of one cell.
  const auto put = [&](std::size_t k, double half, double before, double after) {
    half *= problem_.share[k];
    nodes_.time[k] = half * (before + after);
    nodes_.t0[k] = k > 0 ? half * left_[k - 1] : 0;
    nodes_.t1[k] = half * ((k > 0 ? right_[k - 1] : 0) + (k < n_ ? left_[k] : 0));
    nodes_.t2[k] = k < n_ ? half * right_[k] : 0;
  };
  put(0, problem_.from_rest ? 1 : 0.5, problem_.from_rest ? 0 : problem_.time_before, tau_[0]);
  for (std::size_t k = 1; k < n_; ++k) put(k, 0.5, tau_[k - 1], tau_[k]);
  put(n_, 1, tau_[n_ - 1], 0);
}

// Takes a step: first the speeds, then slacks and multipliers with the rows' new values. Finds the
// sum of the complementarity and the worst row.
void Solver::move(double primal, double dual, double least) {
  for (std::size_t k = 1; k < n_; ++k) nodes_.b[k] += primal * nodes_.step[k];
  times();
  RowTotals totals{};
  for (Joint& joint : joints_) {
    kernels_.move_acceleration(joint.acceleration, joint.cells, nodes_, primal, dual, least,
                               totals);
    if (joint.has_jerk)
      kernels_.move_jerk(joint.jerk, joint.cells, nodes_, primal, dual, least, totals);
  }
  const double* product = totals.product;
  product_ = (product[0] + product[1]) + (product[2] + product[3]);
  violation_ = *std::max_element(totals.violation, totals.violation + row_lanes);
  for (std::size_t k = 1; k < n_; ++k) {
    const double left = 1 - nodes_.b[k] / cap_[k];
    cap_slack_[k] = std::max({cap_slack_[k] + primal * cap_slack_step_[k], left, least});
    cap_multiplier_[k] += dual * cap_multiplier_step_[k];
    violation_ = std::max(violation_, -left);
    product_ += cap_slack_[k] * cap_multiplier_[k];
  }
}

void Solver::add_times() {
  auto& [d0, d1, d2] = matrix_;
  for (std::size_t k = 0; k < n_; ++k) {
    const double v0 = over_v_[k], v1 = over_v_[k + 1], over = over_sum_[k];
    const double part = h_[k] * over * over;
    step_[k] -= left_[k];
    step_[k + 1] -= right_[k];
    d0[k] += part * v0 * v0 * (0.5 * v0 + over);
    d0[k + 1] += part * v1 * v1 * (0.5 * v1 + over);
    d1[k] += part * over * v0 * v1;
  }
}

void Solver::add_caps(double mu) {
  for (std::size_t k = 1; k < n_; ++k) {
    const double over_slack = 1 / cap_slack_[k], over_cap = 1 / cap_[k];
    const double w = cap_multiplier_[k] * over_slack;
    const double residual = nodes_.b[k] * over_cap - 1 + cap_slack_[k];
    matrix_.d0[k] += w * over_cap * over_cap;
    step_[k] -= (mu * over_slack + w * residual) * over_cap;
  }
}

void Solver::add_rows(double mu) {
  for (double* sum : sums_.of) std::fill_n(sum, n_ + 1 + row_lanes, 0.0);
  for (const Joint& joint : joints_) {
    kernels_.sum_acceleration(joint.acceleration, joint.cells, nodes_, mu, sums_);
    if (joint.has_jerk) kernels_.sum_jerk(joint.jerk, joint.cells, nodes_, mu, sums_);
  }
  auto& [d0, d1, d2] = matrix_;
  const auto& of = sums_.of;
  const auto n = static_cast<std::ptrdiff_t>(n_);
  for (std::ptrdiff_t k = 0; k <= n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    d0[i] += of[1][k] + of[0][k + 1] + of[2][k - 1];
    d1[i] += of[4][k] + of[3][k + 1];
    d2[i] += of[5][k + 1];
    step_[i] -= of[7][k] + of[6][k + 1] + of[8][k - 1];
  }
}

void Solver::assemble(double mu) {
  matrix_.clear(n_ + 1);
  step_.assign(n_ + 1, 0);
  add_times();
  add_caps(mu);
  add_rows(mu);
  for (const std::size_t end : {std::size_t{0}, n_}) {
    matrix_.pin(end);
    step_[end] = 0;
  }
  matrix_.solve(step_);
  std::copy(step_.begin(), step_.end(), nodes_.step);
}

// Steps of slacks and multipliers, and how far both can go.
void Solver::directions(double mu) {
  constexpr double most = 0.97;
  RowReach reach{};
  for (Joint& joint : joints_) {
    kernels_.aim_acceleration(joint.acceleration, joint.cells, nodes_, mu, reach);
    if (joint.has_jerk) kernels_.aim_jerk(joint.jerk, joint.cells, nodes_, mu, reach);
  }
  double primal = *std::max_element(reach.primal, reach.primal + row_lanes);
  double dual = *std::max_element(reach.dual, reach.dual + row_lanes);
  for (std::size_t k = 1; k < n_; ++k) {
    const double s = cap_slack_[k], m = cap_multiplier_[k], over_cap = 1 / cap_[k];
    const double ds = 1 - (nodes_.b[k] + step_[k]) * over_cap - s;
    const double dm = (mu - m * ds) / s - m;
    primal = std::max({primal, -ds / s, -most / 0.9 * step_[k] / nodes_.b[k]});
    dual = std::max(dual, -dm / m);
    cap_slack_step_[k] = ds;
    cap_multiplier_step_[k] = dm;
  }
  primal_step_ = std::min(1.0, most / primal);
  dual_step_ = std::min(1.0, most / dual);
}

JerkSolution Solver::run() {
  JerkSolution out;
  move(0, 0, 0.1);
  const double start = objective_ / static_cast<double>(count_);
  for (Joint& joint : joints_)
    for (Rows* rows : {&joint.acceleration, &joint.jerk})
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < rows->count; ++k) rows->m[side][k] = start / rows->s[side][k];
  for (std::size_t k = 1; k < n_; ++k) cap_multiplier_[k] = start / cap_slack_[k];
  product_ = start * static_cast<double>(count_);
  double centring = 0.3;
  for (out.rounds = 0; out.rounds < most_rounds; ++out.rounds) {
    if (!std::isfinite(product_)) return {problem_.guess, infinity, out.rounds};
    if (out.rounds > 0 && product_ < relative_gap * objective_ && violation_ < small_violation)
      break;
    const double mu = centring * product_ / static_cast<double>(count_);
    assemble(mu);
    directions(mu);
    move(primal_step_, dual_step_, 0);
    const double went = std::min(primal_step_, dual_step_);
    centring = went > 0.8 ? 0.1 : went > 0.4 ? 0.25 : 0.6;
  }
  out.violation = std::isfinite(objective_) ? violation_ : infinity;
  out.b.assign(nodes_.b, nodes_.b + n_ + 1);
  return out;
}

}  // namespace

JerkSolution solve(const JerkProblem& problem, double acceleration_room) {
  return Solver(problem, acceleration_room).run();
}

}  // namespace aircut::plan
