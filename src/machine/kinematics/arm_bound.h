// How far the joints of an arm that is solved numerically travel while its tip stays in a box:
// proven from the Jacobian at the box' centre.
//
// Let q_c be the joints at the centre and B the box |q_j − q_c,j| ≤ r_j of joints. Along any way of
// the words w the joints follow J(q) q' = W(w) w', so with J = J_c + ΔJ and W = W_c + ΔW
//
//   q' = J_c⁻¹ (W w' − ΔJ q')    ⇒    |q'| ≤ (1 − K)⁻¹ |J_c⁻¹ W| |w'|,   K = |J_c⁻¹| · max_B |ΔJ|,
//
// element by element, when the non-negative K is a contraction. Going straight from the centre to
// any pose of the box the joints can't leave B if this, with half the box' sizes for w', is within
// r: there is a solution for every pose, it is the only one near by, and J stays regular. The same
// with the words' whole ways for w' is the travel. (Continuation of the implicit function; the same
// reasoning as Kantorovich's for Newton's method.)
//
// ΔJ comes from the second derivatives of the tip, vectors of the form z_k × (z_j × (p − o)), whose
// norms are bounded by the reach of the joints.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "machine/machine.h"

namespace aircut::machine {

/// Columns: joints; rows: three of the tip, mm, then those of its turn, λ·rad (none, 2 or 3).
using ArmMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, max_joints>;

struct ArmAt {
  ArmMatrix jacobian;                                       ///< square, at the centre of the box
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> words;  ///< derivative of its rows by X … C
  std::array<double, 6> reach{};                            ///< |p − o_j|, mm, tip from joint j
  std::array<bool, 6> rotary{};
  double lambda = 1;  ///< mm per rad
};

/// Bounds of the ways of the joints; false when there is no proof for a box of this size.
bool bound_arm_travel(const ArmAt& arm, const TipInterval& tip, std::span<double> travel);

}  // namespace aircut::machine
