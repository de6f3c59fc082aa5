// Private: a path piece as the speed planner sees it: nodes along s with the limits there.
#pragma once

#include <vector>

#include "plan/blend.h"
#include "plan/joint_path.h"

namespace aircut::plan {

/// Limits of the joints, by JointId: mm/s, mm/s², mm/s³ or rad/s …; the jerk's may be infinite.
struct JointLimits {
  machine::JointVector v, a, j;
  double tip_a = std::numeric_limits<double>::infinity();  ///< of the tip as a vector, mm/s²
  bool has_jerk() const { return !j.array().isInf().all(); }
};

JointLimits limits_of(const machine::Machine& machine);

inline constexpr int most_tip_rows = 32;

struct GridNode {
  double s = 0;
  double cap = 0;   ///< largest b by feed and joint speeds
  double room = 1;  ///< of the interval behind: 1 minus what its rows can be wrong between nodes
  Cause why = {};   ///< what caps the speed
  double feed_cap = 0, joint_cap = 0;  ///< by either alone, without overrides
  Cause joint_why = {};                ///< whose speed joint_cap is of
};

/// Nodes of one piece. `b` is the squared path speed.
///
/// A uniform piece (joints linear in s) needs no inner nodes: its limits are constants and its
/// profile is a closed form. Otherwise node k has one row per joint: |alpha u + beta b| ≤ room,
/// with u the path acceleration, alpha = q' / A, beta = q'' / A.
struct Grid {
  bool uniform = false;
  double uniform_a = 0;           ///< largest |u| of a uniform piece
  signed char uniform_joint = 0;  ///< whose limit that is
  int joints = 0;  ///< rows of a node: the joints', then `tip_rows` of the tip's limit
  int tip_rows = 0;
  std::vector<GridNode> at;       ///< by s, first 0, last the length
  std::vector<double> rows;       ///< per node: alpha of every joint, then beta of every joint
  machine::JointVector dq_start;  ///< q' at the start

  std::size_t nodes() const { return at.size(); }
  double length() const { return at.back().s; }
  const double* alpha(std::size_t node) const {
    return rows.data() + node * 2 * static_cast<std::size_t>(joints);
  }
  const double* beta(std::size_t node) const { return alpha(node) + joints; }
};

/// Caps for `factor` times the feed, or that share of a rapid's speed. Nothing to do for 1.
void scale_caps(Grid& grid, double factor);
/// Nodes nearer than this share of the length to a place where the grid is cut fall together with
/// it.
inline constexpr double same_node = 1e-9;
/// The parts of a grid before and behind `s`, with a node there.
Grid grid_before(const Grid& grid, double s);
Grid grid_behind(const Grid& grid, double s);

/// How a piece joins its neighbours.
struct GridEnds {
  machine::JointVector q_end;  ///< joints at the end of the piece
  machine::JointVector dq_end;
  machine::JointVector ddq_start, ddq_end;
  AxisValues d_start, d_end, dd_end;  ///< of the tip
};
struct MadeGrid {
  Grid grid;
  GridEnds ends;
};

/// The piece can't be carried out beyond `s`.
struct GridFailure {
  double s = 0;  ///< last place that is good
  bool singular = false;
  std::string reason;
};

/// What is known of a blend between two lines where the joints are linear in the tip, or nearly so
/// over the whole blend: at the places of `rates` the curve need not be looked at.
struct KnownRates {
  CornerRates rates;
  double cut = 0;
  AxisValues d_in, d_out;  ///< directions of the lines, by their XYZ length
  machine::JointVector dq_in, dq_out;
  /// q'' along the lines where the joints are only nearly linear; then the ends are looked at.
  machine::JointVector ddq_in, ddq_out;
};

/// How a piece follows the one before it, which `out` of make_grid() still holds.
enum class Follows {
  nothing,     ///< or nothing is known
  at_speed,    ///< begins where that one ends
  same_curve,  ///< is the other part of the same curve
};

/// `near`: joints at the start. `feed` limits the tip's speed along `metric` (infinity: a rapid).
/// Fills `out`, whose memory is used again. `passes`: the piece neither starts nor ends at rest.
std::optional<GridFailure> make_grid(const machine::Kinematics& kinematics, const Path& path,
                                     Metric metric, double feed, const AxisValues& tool_offset,
                                     const JointLimits& limits, const machine::JointVector& near,
                                     MadeGrid& out, Follows follows = Follows::nothing,
                                     bool passes = false, const KnownRates* known = nullptr);

}  // namespace aircut::plan
