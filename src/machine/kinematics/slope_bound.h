// The travel of joints over a box of poses, from an inverse that works on any number type.
//
// Joint j moves along a path inside the box by at most
//
//   Σ_i  max over the box |∂q_j / ∂p_i| · (way of p_i)
//
// The maxima come from evaluating the inverse with intervals (derivatives.h), which is a proof that
// the whole box can be reached, too: where there is no pose, a root, an arc cosine, a quotient or
// an angle has no bound. A box without a bound is halved, up to `splits` times, because intervals
// overestimate large boxes.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "machine/kinematics/derivatives.h"

namespace aircut::machine {

/// Pose words X Y Z A B C, mm and rad; zero where a machine has no such axis.
template <class T>
using PoseWords = std::array<T, 6>;

/// Raises `travel` to a bound over `box`; false when there is none. `solve(const
/// PoseWords<Slope>&)` gives the joints of one branch as a container of Slope.
template <class Solve>
bool raise_travel(const PoseWords<Interval>& box, const PoseWords<double>& way, int splits,
                  std::span<double> travel, Solve&& solve) {
  PoseWords<Slope> pose;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    pose[i] = Slope(box[i]);
    pose[i].d[i] = Interval(1);
  }
  const auto bounded = [&](const Slope& q) {
    return q.v.finite() &&
           std::all_of(q.d.begin(), q.d.end(), [](const Interval& d) { return d.finite(); });
  };
  const auto joints = solve(pose);
  if (std::all_of(joints.begin(), joints.begin() + static_cast<long>(travel.size()), bounded)) {
    for (std::size_t j = 0; j < travel.size(); ++j) {
      Interval sum(0);
      for (std::size_t i = 0; i < way.size(); ++i)
        sum = sum + Interval(joints[j].d[i].magnitude()) * Interval(way[i]);
      travel[j] = std::max(travel[j], sum.high);
    }
    return true;
  }
  if (splits == 0) return false;
  // A radian moves a tool by about as much as a metre does.
  std::size_t widest = 0;
  double width = 0;
  for (std::size_t i = 0; i < box.size(); ++i) {
    const double w = (box[i].high - box[i].low) * (i < 3 ? 1 : 1000);
    if (w > width) {
      width = w;
      widest = i;
    }
  }
  if (width == 0) return false;
  PoseWords<Interval> half = box;
  half[widest].high = box[widest].middle();
  if (!raise_travel(half, way, splits - 1, travel, solve)) return false;
  half[widest] = {box[widest].middle(), box[widest].high};
  return raise_travel(half, way, splits - 1, travel, solve);
}

}  // namespace aircut::machine
