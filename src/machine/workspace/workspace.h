// Which places a machine reaches: a grid of points, each in or out, and what can be read from it.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "machine/machine.h"

namespace aircut::machine {

struct WorkspaceQuery {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< M, mm; an axis with low = high is not searched
  double pitch = 10;                             ///< mm
  bool nodes = false;             ///< points at low, low + pitch, … high; else centres of cells
  std::vector<AxisValues> tilts;  ///< A B C that a point must allow, all of them; rad. Empty: zero
  AxisValues tool_offset;
  /// Is nothing in the way at these joints? Called from several threads. Empty: not asked.
  std::function<bool(const JointVector&)> is_free;
  int threads = 0;  ///< 0: one per core. The result does not depend on it
};

/// A box of grid points, by the places of its first and last ones.
struct GridBox {
  std::array<int, 3> first{0, 0, 0}, last{-1, -1, -1};
  long points() const;
};

class Workspace {
 public:
  static constexpr long max_points = 20'000'000;

  /// Empty when the grid would have more than max_points points.
  static std::optional<Workspace> of(const Machine& machine, const WorkspaceQuery& query);
  /// For tests of what is read from it: in and out by a function of the places.
  template <class In>
  static Workspace by(const std::array<int, 3>& count, In&& in) {
    Workspace w;  // its points are 1 mm apart, the first one at the origin
    w.count_ = count;
    for (int k = 0; k < count[2]; ++k)
      for (int j = 0; j < count[1]; ++j)
        for (int i = 0; i < count[0]; ++i) w.bits_.push_back(in(i, j, k) ? 1 : 0);
    return w;
  }

  const std::array<int, 3>& count() const { return count_; }
  double pitch() const { return pitch_; }
  long points() const { return static_cast<long>(bits_.size()); }
  bool in(int i, int j, int k) const { return bits_[at(i, j, k)] != 0; }
  Vec3 place(int i, int j, int k) const;
  long reached() const;
  /// Reached points with a neighbour that is not reached, or beyond the grid: the part of `reached`
  /// that is uncertain by the pitch.
  long at_border() const;
  /// First and last reached place of each axis; empty when none is.
  GridBox extent() const;
  /// The largest axis-parallel box of reached points; of several the first in ascending (z, y, x).
  GridBox largest_box() const;
  /// Keeps what is connected with the point nearest to p, by neighbours along the axes; false, and
  /// nothing is changed, when that point is not reached.
  bool keep_connected(const Vec3& p);
  /// Points that failed by each joint's limit, by JointId, then those without a solution, and last
  /// those where something is in the way.
  const std::vector<long>& failures() const { return failures_; }

 private:
  std::size_t at(int i, int j, int k) const {
    return static_cast<std::size_t>((static_cast<long>(k) * count_[1] + j) * count_[0] + i);
  }

  std::array<int, 3> count_{1, 1, 1};
  Vec3 first_ = Vec3::Zero();
  double pitch_ = 1;
  std::vector<unsigned char> bits_;  ///< x fastest
  std::vector<long> failures_;
};

/// The tilts of a box A1..A2, B1..B2 (rad): a grid of at most 5°, with its corners and edges.
std::vector<AxisValues> tilts_of_box(double a1, double a2, double b1, double b2);

/// A box around what random joints inside the travel reach (fixed seed), or nothing.
std::optional<Box3> reach_box(const Machine& machine);

}  // namespace aircut::machine
