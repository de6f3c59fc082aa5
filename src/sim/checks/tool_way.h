// Private: the way of the tool over a step, seen from the stock, as straight moves with a fixed
// axis. What they sweep differs from what the tool sweeps by at most the given tolerance.
#pragma once

#include <vector>

#include "sim/sim.h"

namespace aircut::sim {

/// The tip goes straight from `from` to `to`; the axis points from the tip to the spindle. Stock
/// frame S, mm.
struct StraightMove {
  Vec3 from, to, axis;
  double s0 = 0, s1 = 0;  ///< where on the segment's path, mm
};

/// The part of the tool that matters: from the tip up to `height`, at most `radius` wide, mm.
struct Reach {
  double radius = 0, height = 0;
};

/// Program time at which the step's path is done up to `s` mm.
double time_at(const Step& step, double s);

/// Does the tool turn over the stock in this step? If not, its moves don't depend on the reach.
bool turns(const Step& step, const machine::RawStock& stock);

/// Appends the moves of a step in their order. False when there is no such list: the machine does
/// not reach a place of the path, or the way needs more than a million moves.
///
/// Where A, B and C rest the tip's way is the commanded one, moved: a line stays one; an arc
/// of radius r is cut into chords with a sagitta r (1 − cos(φ/2)) ≤ tolerance; a Bezier curve
/// of degree n into equal steps of u, whose distance from their chords is at most
/// n (n − 1) max|Δ²| Δu² / 8. Where the tool turns, steps in which
/// its axis turns by at most 2 · tolerance / ρ about the middle of the reach, whose farthest point
/// is ρ away, with the mean axis of each; and the way of that middle is compared with its chord
/// halfway.
bool straight_moves(const Step& step, const machine::RawStock& stock, const Reach& reach,
                    double tolerance, std::vector<StraightMove>& out);

}  // namespace aircut::sim
