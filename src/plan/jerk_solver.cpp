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
// O(nodes · joints).
#include "plan/jerk_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/five_diagonals.h"

namespace aircut::plan {
namespace {

using Vector = std::vector<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int most_rounds = 80;
constexpr double relative_gap = 1e-4;
constexpr double small_violation = 1e-7;

// Slacks and multipliers of |l| ≤ R for all places of one joint.
struct Rows {
  Vector s_plus, s_minus, m_plus, m_minus;
  void resize(std::size_t n) {
    for (Vector* v : {&s_plus, &s_minus, &m_plus, &m_minus}) v->assign(n, 0);
  }
};

class Solver {
 public:
  Solver(const JerkProblem& problem, double acceleration_room);
  JerkSolution run();

 private:
  // Calls f(joint) for joints that move in this window.
  template <class F>
  void each_joint(F f) {
    for (std::size_t j = 0; j < problem_.joints; ++j)
      if (moves_[j]) f(j);
  }
  void times();
  void residuals(bool first);
  void assemble(double mu);
  void directions(double mu);
  void update();

  const double* p(std::size_t j) const { return p_.data() + j * (n_ + 2) + 1; }
  const double* r(std::size_t j) const { return r_.data() + j * (n_ + 2) + 1; }
  double* q(std::size_t j) { return q_.data() + j * (n_ + 2) + 1; }
  bool has_jerk(std::size_t j) const { return std::isfinite(rate_[j]); }

  const JerkProblem& problem_;
  std::size_t n_;  ///< cells
  double room_;    ///< of acceleration
  Vector b_, cap_, rate_;
  std::vector<bool> moves_;
  Vector p_, r_, q_;  ///< per joint n + 2: cell −1 and cell n around the others
  // Of the times: τ, its derivatives by the two ends, and T of the jerk rows with its three.
  Vector tau_, left_, right_, gap_time_, t0_, t1_, t2_;
  double objective_ = 0, product_ = 0, violation_ = 0;
  std::size_t count_ = 0;
  std::vector<Rows> acceleration_, jerk_;
  Vector cap_slack_, cap_multiplier_;
  FiveDiagonals matrix_;
  Vector step_;
  // Scratch of one joint's rows: weight, difference of weights, force.
  Vector weight_, skew_, push_, pull_;
  double primal_step_ = 1, dual_step_ = 1;
  std::vector<Rows> acceleration_step_, jerk_step_;
  Vector cap_slack_step_, cap_multiplier_step_;
};

Solver::Solver(const JerkProblem& problem, double acceleration_room)
    : problem_(problem),
      n_(problem.cells()),
      room_(acceleration_room),
      b_(problem.guess),
      cap_(problem.cap),
      rate_(problem.rate),
      moves_(problem.joints) {
  const std::size_t nodes = n_ + 1, padded = n_ + 2;
  p_.assign(problem.joints * padded, 0);
  r_ = q_ = p_;
  for (std::size_t j = 0; j < problem.joints; ++j) {
    double size = std::abs(problem.from_rest ? 0 : problem.q_before[j]);
    for (std::size_t k = 0; k < n_; ++k) {
      p_[j * padded + 1 + k] = problem.p[j * n_ + k];
      r_[j * padded + 1 + k] = problem.r[j * n_ + k];
      size = std::max({size, std::abs(problem.p[j * n_ + k]), std::abs(problem.r[j * n_ + k])});
    }
    q_[j * padded] = problem.from_rest ? 0 : problem.q_before[j];
    moves_[j] = size > 0;
  }
  for (Vector* v : {&tau_, &left_, &right_}) v->assign(n_, 0);
  for (Vector* v : {&gap_time_, &t0_, &t1_, &t2_, &weight_, &skew_, &push_, &pull_, &cap_slack_,
                    &cap_multiplier_, &cap_slack_step_, &cap_multiplier_step_})
    v->assign(nodes, 0);
  for (auto* rows : {&acceleration_, &acceleration_step_, &jerk_, &jerk_step_}) {
    rows->resize(problem.joints);
    each_joint([&](std::size_t j) { (*rows)[j].resize(nodes); });
  }
  b_.front() = problem.from_rest ? 0 : problem.b_start;
  b_.back() = 0;
  for (std::size_t k = 1; k < n_; ++k) b_[k] = std::min(b_[k], 0.9 * cap_[k]);
}

// Times of the cells and of the jerk rows with their derivatives. Fixed ends have none.
void Solver::times() {
  objective_ = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    const double h = problem_.x[k + 1] - problem_.x[k];
    const double v0 = std::sqrt(b_[k]), v1 = std::sqrt(b_[k + 1]);
    const double sum = v0 + v1;
    tau_[k] = 2 * h / sum;
    left_[k] = k > 0 ? -h / (sum * sum * v0) : 0;
    right_[k] = k + 1 < n_ ? -h / (sum * sum * v1) : 0;
    objective_ += tau_[k];
  }
  for (std::size_t k = 0; k <= n_; ++k) {
    double half = (k == 0 && problem_.from_rest) || k == n_ ? 1 : 0.5;
    gap_time_[k] = half * ((k > 0 ? tau_[k - 1] : problem_.time_before) + (k < n_ ? tau_[k] : 0));
    if (k == 0 && problem_.from_rest) gap_time_[k] = tau_[0];
    // The share of the limit goes into the time that the row counts.
    half *= problem_.share[k];
    gap_time_[k] *= problem_.share[k];
    t0_[k] = k > 0 ? half * left_[k - 1] : 0;
    t1_[k] = half * ((k > 0 ? right_[k - 1] : 0) + (k < n_ ? left_[k] : 0));
    t2_[k] = k < n_ ? half * right_[k] : 0;
  }
}

// Slacks from the rows, or kept where a row is still broken; sums of the complementarity.
void Solver::residuals(bool first) {
  product_ = violation_ = 0;
  count_ = 0;
  const auto take = [&](double limit, double value, double& slack, double multiplier) {
    const double true_slack = limit - value;
    slack = first ? std::max(true_slack, 0.1 * limit) : std::max(slack, true_slack);
    violation_ = std::max(violation_, -true_slack / limit);
    product_ += slack * multiplier;
  };
  each_joint([&](std::size_t j) {
    const double *p_j = p(j), *r_j = r(j);
    double* q_j = q(j);
    for (std::size_t k = 0; k < n_; ++k) q_j[k] = p_j[k] * b_[k] + r_j[k] * b_[k + 1];
    Rows& a = acceleration_[j];
    for (std::size_t k = 0; k < n_; ++k) {
      take(room_, q_j[k], a.s_plus[k], a.m_plus[k]);
      take(room_, -q_j[k], a.s_minus[k], a.m_minus[k]);
    }
    count_ += 2 * n_;
    if (!has_jerk(j)) return;
    Rows& z = jerk_[j];
    for (std::size_t k = 0; k <= n_; ++k) {
      const double change = q_j[k] - q_j[static_cast<std::ptrdiff_t>(k) - 1];
      const double limit = rate_[j] * gap_time_[k];
      take(limit, change, z.s_plus[k], z.m_plus[k]);
      take(limit, -change, z.s_minus[k], z.m_minus[k]);
    }
    count_ += 2 * (n_ + 1);
  });
  for (std::size_t k = 1; k < n_; ++k) take(1, b_[k] / cap_[k], cap_slack_[k], cap_multiplier_[k]);
  count_ += n_ - 1;
}

void Solver::assemble(double mu) {
  matrix_.clear(n_ + 1);
  step_.assign(n_ + 1, 0);
  auto& [d0, d1, d2] = matrix_;
  for (std::size_t k = 0; k < n_; ++k) {
    const double h = problem_.x[k + 1] - problem_.x[k];
    const double v0 = std::sqrt(b_[k]), v1 = std::sqrt(b_[k + 1]), sum = v0 + v1;
    step_[k] -= left_[k];
    step_[k + 1] -= right_[k];
    const double s2 = sum * sum, s3 = s2 * sum;
    if (k > 0) d0[k] += h * (0.5 / (s2 * v0 * v0 * v0) + 1 / (s3 * v0 * v0));
    if (k + 1 < n_) d0[k + 1] += h * (0.5 / (s2 * v1 * v1 * v1) + 1 / (s3 * v1 * v1));
    if (k > 0 && k + 1 < n_) d1[k] += h / (s3 * v0 * v1);
  }
  for (std::size_t k = 1; k < n_; ++k) {
    const double w = cap_multiplier_[k] / cap_slack_[k];
    const double residual = b_[k] / cap_[k] - 1 + cap_slack_[k];
    d0[k] += w / (cap_[k] * cap_[k]);
    step_[k] -= (mu / cap_slack_[k] + w * residual) / cap_[k];
  }
  each_joint([&](std::size_t j) {
    const double *p_j = p(j), *r_j = r(j);
    const double* q_j = q(j);
    // Weight and force of both sides of all rows of one kind: Σ λ/s, their difference, and the
    // sums of (μ + λ (c + s)) / s.
    const auto weigh = [&](const Rows& rows, std::size_t count, auto limit, auto value) {
      for (std::size_t k = 0; k < count; ++k) {
        const double l = value(k), r = limit(k);
        const double over_plus = 1 / rows.s_plus[k], over_minus = 1 / rows.s_minus[k];
        const double w_plus = rows.m_plus[k] * over_plus, w_minus = rows.m_minus[k] * over_minus;
        const double z_plus = mu * over_plus + w_plus * (l - r + rows.s_plus[k]);
        const double z_minus = mu * over_minus + w_minus * (-l - r + rows.s_minus[k]);
        weight_[k] = w_plus + w_minus;
        skew_[k] = w_plus - w_minus;
        push_[k] = z_plus - z_minus;
        pull_[k] = z_plus + z_minus;
      }
    };
    weigh(
        acceleration_[j], n_, [&](std::size_t) { return room_; },
        [&](std::size_t k) { return q_j[k]; });
    for (std::size_t k = 0; k < n_; ++k) {
      d0[k] += weight_[k] * p_j[k] * p_j[k];
      d0[k + 1] += weight_[k] * r_j[k] * r_j[k];
      d1[k] += weight_[k] * p_j[k] * r_j[k];
      step_[k] -= push_[k] * p_j[k];
      step_[k + 1] -= push_[k] * r_j[k];
    }
    if (!has_jerk(j)) return;
    const double rate = rate_[j];
    weigh(
        jerk_[j], n_ + 1, [&](std::size_t k) { return rate * gap_time_[k]; },
        [&](std::size_t k) { return q_j[k] - q_j[static_cast<std::ptrdiff_t>(k) - 1]; });
    for (std::size_t k = 0; k <= n_; ++k) {
      // Rows ±l − rate T: l over the nodes k − 1, k, k + 1.
      const auto i = static_cast<std::ptrdiff_t>(k);
      const double l0 = -p_j[i - 1], l1 = p_j[i] - r_j[i - 1], l2 = r_j[i];
      const double g0 = rate * t0_[k], g1 = rate * t1_[k], g2 = rate * t2_[k];
      const double w = weight_[k], d = skew_[k], push = push_[k], pull = pull_[k];
      d0[k] += w * (l1 * l1 + g1 * g1) - 2 * d * l1 * g1;
      step_[k] -= push * l1 - pull * g1;
      if (k > 0) {
        d0[k - 1] += w * (l0 * l0 + g0 * g0) - 2 * d * l0 * g0;
        d1[k - 1] += w * (l0 * l1 + g0 * g1) - d * (l0 * g1 + l1 * g0);
        step_[k - 1] -= push * l0 - pull * g0;
      }
      if (k < n_) {
        d0[k + 1] += w * (l2 * l2 + g2 * g2) - 2 * d * l2 * g2;
        d1[k] += w * (l1 * l2 + g1 * g2) - d * (l1 * g2 + l2 * g1);
        step_[k + 1] -= push * l2 - pull * g2;
      }
      if (k > 0 && k < n_) d2[k - 1] += w * (l0 * l2 + g0 * g2) - d * (l0 * g2 + l2 * g0);
    }
  });
  for (const std::size_t end : {std::size_t{0}, n_}) {
    matrix_.pin(end);
    step_[end] = 0;
  }
  matrix_.solve(step_);
}

// Steps of slacks and multipliers, and how far both can go.
void Solver::directions(double mu) {
  constexpr double most = 0.97;
  double primal = 1 / most, dual = 1 / most;
  const auto row = [&](double limit, double value, double change, double slack, double multiplier,
                       double& slack_step, double& multiplier_step) {
    slack_step = limit - value - slack - change;
    multiplier_step = (mu - multiplier * slack_step) / slack - multiplier;
    if (slack_step < 0) primal = std::min(primal, -slack / slack_step);
    if (multiplier_step < 0) dual = std::min(dual, -multiplier / multiplier_step);
  };
  each_joint([&](std::size_t j) {
    const double *p_j = p(j), *r_j = r(j);
    const double* q_j = q(j);
    const auto both = [&](Rows& rows, Rows& steps, std::size_t k, double limit, double value,
                          double change, double widen) {
      row(limit, value, change - widen, rows.s_plus[k], rows.m_plus[k], steps.s_plus[k],
          steps.m_plus[k]);
      row(limit, -value, -change - widen, rows.s_minus[k], rows.m_minus[k], steps.s_minus[k],
          steps.m_minus[k]);
    };
    for (std::size_t k = 0; k < n_; ++k)
      both(acceleration_[j], acceleration_step_[j], k, room_, q_j[k],
           p_j[k] * step_[k] + r_j[k] * step_[k + 1], 0);
    if (!has_jerk(j)) return;
    for (std::size_t k = 0; k <= n_; ++k) {
      const auto i = static_cast<std::ptrdiff_t>(k);
      const double before = k > 0 ? step_[k - 1] : 0, after = k < n_ ? step_[k + 1] : 0;
      const double change =
          -p_j[i - 1] * before + (p_j[i] - r_j[i - 1]) * step_[k] + r_j[i] * after;
      const double widen = rate_[j] * (t0_[k] * before + t1_[k] * step_[k] + t2_[k] * after);
      both(jerk_[j], jerk_step_[j], k, rate_[j] * gap_time_[k], q_j[i] - q_j[i - 1], change, widen);
    }
  });
  for (std::size_t k = 1; k < n_; ++k) {
    row(1, b_[k] / cap_[k], step_[k] / cap_[k], cap_slack_[k], cap_multiplier_[k],
        cap_slack_step_[k], cap_multiplier_step_[k]);
    if (step_[k] < 0) primal = std::min(primal, -0.9 / most * b_[k] / step_[k]);
  }
  primal_step_ = std::min(1.0, most * primal);
  dual_step_ = std::min(1.0, most * dual);
}

void Solver::update() {
  const auto add = [](Vector& to, const Vector& step, double share) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += share * step[k];
  };
  add(b_, step_, primal_step_);
  add(cap_slack_, cap_slack_step_, primal_step_);
  add(cap_multiplier_, cap_multiplier_step_, dual_step_);
  const auto both = [&](Rows& rows, const Rows& steps) {
    add(rows.s_plus, steps.s_plus, primal_step_);
    add(rows.s_minus, steps.s_minus, primal_step_);
    add(rows.m_plus, steps.m_plus, dual_step_);
    add(rows.m_minus, steps.m_minus, dual_step_);
  };
  each_joint([&](std::size_t j) {
    both(acceleration_[j], acceleration_step_[j]);
    if (has_jerk(j)) both(jerk_[j], jerk_step_[j]);
  });
}

JerkSolution Solver::run() {
  JerkSolution out;
  times();
  residuals(true);
  const double start = 0.3 * objective_ / static_cast<double>(count_);
  const auto fill = [start](const Vector& slack, Vector& multiplier) {
    for (std::size_t k = 0; k < slack.size(); ++k)
      if (slack[k] > 0) multiplier[k] = start / slack[k];
  };
  each_joint([&](std::size_t j) {
    for (auto* rows : {&acceleration_[j], &jerk_[j]}) {
      fill(rows->s_plus, rows->m_plus);
      fill(rows->s_minus, rows->m_minus);
    }
  });
  fill(cap_slack_, cap_multiplier_);
  double centring = 0.3;
  for (out.rounds = 0; out.rounds < most_rounds; ++out.rounds) {
    times();
    residuals(false);
    if (!std::isfinite(product_)) return {problem_.guess, infinity, out.rounds};
    if (out.rounds > 0 && product_ < relative_gap * objective_ && violation_ < small_violation)
      break;
    const double mu = centring * product_ / static_cast<double>(count_);
    assemble(mu);
    directions(mu);
    update();
    const double went = std::min(primal_step_, dual_step_);
    centring = went > 0.8 ? 0.1 : went > 0.4 ? 0.25 : 0.6;
  }
  if (out.rounds == most_rounds) {
    times();
    residuals(false);
  }
  out.violation = std::isfinite(objective_) ? violation_ : infinity;
  out.b = std::move(b_);
  return out;
}

}  // namespace

JerkSolution solve(const JerkProblem& problem, double acceleration_room) {
  return Solver(problem, acceleration_room).run();
}

}  // namespace aircut::plan
