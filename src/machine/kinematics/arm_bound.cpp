#include "machine/kinematics/arm_bound.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aircut::machine {

namespace {

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using Words = Eigen::Matrix<double, 6, 1>;

// mm: joints that were found numerically are as far off the exact ones as this moves the tip.
constexpr double solved_to = 2e-9;
constexpr double rounding = 1 + 1e-9;

// The largest distance of the tip from each joint inside the box of joints: those behind carry it.
Column largest_reach(const ArmAt& arm, const Column& r) {
  Column reach(r.size());
  for (Eigen::Index j = r.size() - 1; j >= 0; --j) {
    const auto at = static_cast<std::size_t>(j);
    reach[j] = arm.reach[at] + (arm.rotary[at] ? 0.0 : r[j]);
    for (Eigen::Index m = j + 1; m < r.size(); ++m)
      reach[j] += r[m] * (arm.rotary[static_cast<std::size_t>(m)] ? reach[m] : 1.0);
  }
  return reach;
}

// max |ΔJ| inside the box of joints. The derivative of a column by a joint before it turns the
// column; by itself or a joint behind, only the lever to the tip.
Square change_of_jacobian(const ArmAt& arm, const Column& r) {
  const Eigen::Index n = r.size();
  const Column reach = largest_reach(arm, r);
  Square change = Square::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const bool turns = arm.rotary[static_cast<std::size_t>(j)];
    double place = 0, turn = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const bool by_turn = arm.rotary[static_cast<std::size_t>(k)];
      if (k < j && by_turn) place += r[k] * (turns ? reach[j] : 1.0);
      if (k >= j && turns) place += r[k] * (by_turn ? reach[k] : 1.0);
      // Two rows follow a direction, which every joint turns; three the axes, which only those
      // before do.
      if (turns && by_turn && (n == 5 || k < j)) turn += r[k];
    }
    change.col(j).head(3).setConstant(place);
    change.col(j).tail(n - 3).setConstant(arm.lambda * turn);
  }
  return change;
}

}  // namespace

bool bound_arm_travel(const ArmAt& arm, const TipInterval& tip, std::span<double> travel) {
  const Eigen::Index n = arm.jacobian.rows();
  const Square inverse = Square(arm.jacobian).inverse();
  if (!inverse.allFinite()) return false;
  const Square size = inverse.cwiseAbs();

  Words half, way;
  double angles = 0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Axis axis = all_axes[static_cast<std::size_t>(i)];
    half[i] = 0.5 * (tip.high[axis] - tip.low[axis]);
    way[i] = tip.travel[axis];
    if (i >= 3 && i - 3 < (n == 5 ? 2 : n - 3)) angles += half[i];
  }
  // |J_c⁻¹ W|: the axes of the angles' turns are unit vectors that the other angles turn.
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> by_word = (inverse * arm.words).cwiseAbs();
  for (Eigen::Index i = 3; i < 6; ++i) {
    if (i - 3 >= (n == 5 ? 2 : n - 3)) continue;
    for (Eigen::Index row = 3; row < n; ++row)
      by_word.col(i) += size.col(row) * arm.lambda * angles;
  }
  const Column slack = size.rowwise().sum() * solved_to;
  const Column straight = by_word * half + slack;
  // Room for the change of J, also where a joint would stand still without it.
  const Column guess = 2 * straight;
  const Column r = guess + 2 * (size * change_of_jacobian(arm, guess) * guess);

  // straight + K r ≤ r keeps the straight way in B and, as straight > 0, makes K a contraction
  // (its norm weighted by r is below 1).
  const Square K = size * change_of_jacobian(arm, r);
  if (!K.allFinite() || !((straight + K * r).array() <= r.array()).all()) return false;
  // |q'| ≤ a + K |q'|, by repetition: every step is a bound, since the first one is.
  Column most = by_word * way + slack;
  const Column first = most;
  double grown = 0;  // most ≤ grown · r
  for (Eigen::Index j = 0; j < n; ++j) grown = std::max(grown, first[j] / straight[j]);
  most = grown * r;
  for (int round = 0; round < 12; ++round) most = first + K * most;
  for (Eigen::Index j = 0; j < n; ++j) travel[static_cast<std::size_t>(j)] = most[j] * rounding;
  return true;
}

}  // namespace aircut::machine
