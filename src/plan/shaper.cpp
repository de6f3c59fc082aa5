// What happens between two moves.
//
// Exact stop (G61.1) and corners in exact path mode (G61): rest. Joints between tangent pieces are
// passed at speed. "Tangent" always is only nearly so; the joint velocity then jumps by |Δq'| v and
// shows up in the log as an acceleration |Δq'| v / T over one period T. The speed there is held so
// low that this stays below `jump_share` of the joint's limit. Corners of more than `pass_angle`
// would crawl that way: the motion stops there instead.
#include "plan/shaper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/reach.h"

namespace aircut::plan {
namespace {

constexpr double jump_share = 5e-4;
constexpr double pass_angle = 1e-3;  // rad

// One length for nine axes, a radian counted as 100 mm: compares directions only.
double mixed_norm(const AxisValues& way) {
  double sum = 0;
  for (const Axis axis : all_axes) {
    const double value = way[axis] * (is_rotary(axis) ? 100 : 1);
    sum += value * value;
  }
  return std::sqrt(sum);
}

AxisValues start_direction(const Path& path) { return evaluate(path, 0).d; }
AxisValues end_direction(const Path& path) { return evaluate(path, length(path)).d; }

JointLimits limits_of(const machine::Machine& machine) {
  const int n = machine.joint_count();
  JointLimits out{machine::JointVector(n), machine::JointVector(n)};
  for (int j = 0; j < n; ++j) {
    out.v[j] = machine.joint(machine::JointId{j}).vmax;
    out.a[j] = machine.joint(machine::JointId{j}).amax;
  }
  return out;
}

}  // namespace

Shaper::Shaper(const machine::Machine& machine, machine::JointVector start, double period,
               std::size_t max_nodes)
    : machine_(machine),
      limits_(limits_of(machine)),
      period_(period),
      chain_(max_nodes),
      joints_(std::move(start)),
      scratch_(std::max(machine.tree().size(), static_cast<std::size_t>(machine.joint_count()) +
                                                   machine.kinematics().passive_names().size())) {}

Shaper::Corner Shaper::corner_of(const Move& left, const Move& right) const {
  if (left.mode == canon::PathMode::exact_stop || right.mode == canon::PathMode::exact_stop)
    return Corner::stop;
  const AxisValues in = end_direction(left.segment.path);
  const AxisValues out = start_direction(right.segment.path);
  const double n_in = mixed_norm(in), n_out = mixed_norm(out);
  if (!(n_in > 0) || !(n_out > 0)) return Corner::stop;
  const double angle = mixed_norm((1 / n_in) * in - (1 / n_out) * out);
  return angle <= pass_angle ? Corner::pass : Corner::stop;
}

void Shaper::push(Move move) {
  if (failed_) return;
  bool stop_before = true;
  if (pending_) {
    stop_before = corner_of(*pending_, move) == Corner::stop;
    finish_pending();
    if (failed_) return;
  }
  pending_ = std::move(move);
  pending_stops_before_ = stop_before;
}

void Shaper::push_still(Segment segment) {
  if (failed_) return;
  if (pending_)
    after_.push_back(std::move(segment));
  else
    chain_.push_still(std::move(segment));
}

void Shaper::stop() {
  if (failed_) return;
  finish_pending();
  chain_.stop();
}

void Shaper::finish_pending() {
  if (!pending_) return;
  Move move = std::move(*pending_);
  pending_.reset();
  add(std::move(move), pending_stops_before_);
  std::vector<Segment> after = std::move(after_);
  after_.clear();
  if (failed_) return;
  for (Segment& still : after) chain_.push_still(std::move(still));
}

// Gives a piece to the chain, or its good part and the failure.
void Shaper::add(Move move, bool stop_before) {
  Segment& segment = move.segment;
  const machine::Kinematics& kinematics = machine_.kinematics();
  const double whole = length(segment.path);
  if (const auto limit =
          find_reach_limit(kinematics, segment.path, segment.tool_offset, joints_, scratch_)) {
    Failure failure{"unreachable", limit->reason,
                    segment.u0 + (segment.u1 - segment.u0) * limit->good / whole,
                    evaluate(segment.path, limit->bad).p};
    segment.path = sub_path(segment.path, 0, limit->good);
    segment.u1 = failure.fraction;
    failed_ = true;
    segment.failure = std::move(failure);
  }
  // A piece that turns singular on the way is cut there and tried again.
  for (int tries = 0; length(segment.path) > 1e-9 * whole; ++tries) {
    auto grid = make_grid(kinematics, segment.path, move.metric, move.feed, segment.tool_offset,
                          limits_, joints_);
    if (grid) {
      append(std::move(segment), std::move(*grid), stop_before);
      return;
    }
    const double here = length(segment.path);
    const double good = tries < 8 ? std::min(grid.error().s, 0.999 * here) : 0;
    const double fraction = segment.u0 + (segment.u1 - segment.u0) * good / here;
    if (!segment.failure || grid.error().singular)
      segment.failure = Failure{grid.error().singular ? "singular" : "unreachable",
                                grid.error().reason, fraction, evaluate(segment.path, good).p};
    segment.path = sub_path(segment.path, 0, good);
    segment.u1 = fraction;
    failed_ = true;
  }
  // Not even the start of it can be left.
  chain_.stop();
  segment.path = Hold{evaluate(segment.path, 0).p};
  chain_.push_still(std::move(segment));
}

void Shaper::append(Segment segment, Grid grid, bool stop_before) {
  const AxisValues d = start_direction(segment.path);
  Piece piece;
  joints_ = grid.q_end;
  if (!stop_before) {
    const double scale = mixed_norm(d_end_) / mixed_norm(d);  // path speed here per speed before
    piece.per_exit = scale * scale;
    const machine::JointVector jump =
        (grid.dq_start - dq_end_ / scale).cwiseQuotient(limits_.a) / (jump_share * period_);
    const double fastest = 1 / jump.cwiseAbs().maxCoeff();
    piece.entry = std::min(fastest * fastest, grid.cap.front());
  }
  d_end_ = end_direction(segment.path);
  dq_end_ = grid.dq_end;
  piece.segment = std::move(segment);
  piece.grid = std::move(grid);
  const bool last = failed_;
  chain_.push(std::move(piece));
  if (last) chain_.stop();
}

}  // namespace aircut::plan
