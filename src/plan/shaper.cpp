// What happens between two moves.
//
//   exact stop (G61.1)       rest
//   tangent                  passed at speed
//   corner, exact path (G61) rest
//   corner, G64              a blend takes the ends of both sides off; rest where none is possible
//
// "Tangent" always is only nearly so; the joint velocity then jumps by |Δq'| v and shows up in the
// log as an acceleration |Δq'| v / T over one period T. The speed there is held so low that this
// stays below `jump_share` of the joint's limit. Corners of more than `pass_angle` would crawl that
// way: the motion stops there instead. In G64 already a corner of `blend_angle` is blended, because
// a tiny blend costs less than the lower speed.
#include "plan/shaper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/corner_load.h"

namespace aircut::plan {
namespace {

constexpr double jump_share = 8e-4;
constexpr double kink_jerk_share = 5e-3;
constexpr double bend_jerk_share = 0.6;
constexpr double pass_angle = 1e-3;   // rad
constexpr double blend_angle = 1e-7;  // rad: rounding of coordinates, not a corner
constexpr double infinity = std::numeric_limits<double>::infinity();

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

}  // namespace

Shaper::Shaper(const machine::Machine& machine, machine::JointVector start, const Options& options)
    : kinematics_(&machine.kinematics()),
      limits_(limits_of(machine)),
      period_(options.period),
      chain_(options.max_nodes, machine.kinematics(), limits_, start, options.period,
             options.overrides),
      linear_joints_(machine.kinematics().type() == "identity"),
      joints_(std::move(start)),
      scratch_(std::max(machine.tree().size(), static_cast<std::size_t>(machine.joint_count()) +
                                                   machine.kinematics().passive_names().size())) {}

void Shaper::switch_to(const machine::Kinematics& kinematics) {
  kinematics_ = &kinematics;
  proven_.forget();
  linear_joints_ = kinematics.type() == "identity";
}

Shaper::Corner Shaper::corner_to(const Move& right) const {
  const Move& left = *pending_;
  if (left.mode == canon::PathMode::exact_stop || right.mode == canon::PathMode::exact_stop)
    return Rest{};
  const AxisValues in = end_direction(left.segment.path);
  const AxisValues out = start_direction(right.segment.path);
  const double n_in = mixed_norm(in), n_out = mixed_norm(out);
  if (!(n_in > 0) || !(n_out > 0)) return Rest{};
  const double angle = mixed_norm((1 / n_in) * in - (1 / n_out) * out);
  const bool continuous =
      left.mode == canon::PathMode::continuous && right.mode == canon::PathMode::continuous;
  if (angle > blend_angle && continuous && left.metric == Metric::xyz &&
      right.metric == Metric::xyz) {
    const double left_length = length(left.segment.path);
    // A side that starts at rest may give more than half; all of it would leave no room to start.
    const double left_room = std::min(left_length - begin_, (at_rest_ ? 0.9 : 0.5) * left_length);
    const double feed = std::min(left.feed, right.feed);
    const CornerShape shape{left.segment.path, right.segment.path, left_room,
                            length(right.segment.path) / 2, right.tolerance};
    const auto load = [&](const Blend& blend) {
      return load_of(*kinematics_, blend, feed, left.segment.tool_offset, limits_, joints_);
    };
    const auto directions = line_directions(in, out, shape, left.segment.tool_offset);
    Demand demand;
    demand.of_blend = [&load](const Blend& b) { return load(b).demand(); };
    if (directions)
      demand.of_lines = [&](const CornerRates& rates, double cut) {
        return line_load(in, out, *directions, rates, cut, feed).demand();
      };
    if (auto corner = make_blend(shape, demand)) {
      if (directions) corner->directions = *directions;
      if (!limits_.has_jerk()) return *corner;
      const double shorter = std::min(left_length, length(right.segment.path));
      if (stop_is_faster(load(corner->blend), corner->blend, corner->cut, shorter)) return Rest{};
      return *corner;
    }
  }
  if (angle <= pass_angle) return Pass{};
  return Rest{};
}

// q' on both sides of a corner between two lines, by their directions (p' at the corner); nothing
// where the joints' directions change along a blend, so that they don't tell what it asks.
std::optional<CornerDirections> Shaper::line_directions(const AxisValues& in, const AxisValues& out,
                                                        const CornerShape& corner,
                                                        const AxisValues& tool_offset) const {
  const machine::Kinematics& kinematics = *kinematics_;
  CornerDirections to;
  if (linear_joints_) {
    machine::JointVector none;
    kinematics.rates({}, joints_, in, {}, to.in, none);
    kinematics.rates({}, joints_, out, {}, to.out, none);
    return to;
  }
  if (!std::holds_alternative<Line>(corner.left) || !std::holds_alternative<Line>(corner.right))
    return std::nullopt;
  const machine::Target target{evaluate(corner.right, 0).p, tool_offset};
  const auto look = [&](const AxisValues& direction, machine::JointVector& dq,
                        machine::JointVector& bend) {
    auto joint = joint_point(kinematics, target, direction, {}, joints_);
    if (!joint) return false;
    dq = std::move(joint->dq);
    bend = std::move(joint->ddq);
    return true;
  };
  constexpr double little = 0.01;
  if (!look(in, to.in, to.bend_in) || !look(out, to.out, to.bend_out)) return std::nullopt;
  if (!(std::min(corner.left_room, corner.right_room) * turning(to) < little)) return std::nullopt;
  return to;
}

// How fast the joints' directions change along the two lines, as a share of the largest, 1/mm.
double Shaper::turning(const CornerDirections& to) const {
  const auto share = [this](const machine::JointVector& bend, const machine::JointVector& dq) {
    return bend.cwiseQuotient(limits_.a).cwiseAbs().maxCoeff() /
           dq.cwiseQuotient(limits_.a).cwiseAbs().maxCoeff();
  };
  return std::max(share(to.bend_in, to.in), share(to.bend_out, to.out));
}

// What the grid of a blend between lines need not find. Where the joints are not linear in the tip,
// only for blends over which their directions hardly change, a share of `little`. The table takes
// H(in, out) for the mean of H(in, in) and H(out, out), which is H(in − out, in − out) / 2 too
// much: at the feed that may be `hardly` any of an acceleration limit.
std::optional<KnownRates> Shaper::known_rates(const Move& left, const Move& right,
                                              const CornerBlend& corner) const {
  const CornerDirections& to = corner.directions;
  if (!corner.rates || to.in.size() == 0) return std::nullopt;
  const AxisValues in = end_direction(left.segment.path);
  const AxisValues out = start_direction(right.segment.path);
  if (!linear_joints_) {
    constexpr double little = 2e-4, hardly = 2e-3;
    const double feed = std::max(left.feed, right.feed);
    const double bend = std::max(to.bend_in.cwiseQuotient(limits_.a).cwiseAbs().maxCoeff(),
                                 to.bend_out.cwiseQuotient(limits_.a).cwiseAbs().maxCoeff());
    const double turn = mixed_norm(in - out) / std::min(mixed_norm(in), mixed_norm(out));
    if (!(corner.cut * turning(to) < little) || !(feed * feed * bend * turn * turn < hardly))
      return std::nullopt;
  }
  return KnownRates{*corner.rates, corner.cut, in, out, to.in, to.out, to.bend_in, to.bend_out};
}

CornerLoad Shaper::line_load(const AxisValues& in, const AxisValues& out,
                             const CornerDirections& directions, const CornerRates& rates,
                             double cut, double feed) const {
  double cosine = 0;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) cosine += in[axis] * out[axis];
  return load_of_lines(rates, cut, directions.in, directions.out, cosine, feed, limits_);
}

void Shaper::push(Move move) {
  if (failed_) return;
  double begin = 0;
  bool rest = true;
  if (pending_) {
    const Corner corner = corner_to(move);
    rest = std::holds_alternative<Rest>(corner);
    if (const auto* blend = std::get_if<CornerBlend>(&corner)) {
      begin = blend->cut;
      add_blend(*pending_, move, *blend);
    } else {
      finish_pending();
    }
    if (failed_) return;
  }
  if (rest) at_rest_ = true;
  begin_ = begin;
  end_ = length(move.segment.path);
  pending_ = std::move(move);
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
  if (failed_) return;
  chain_.stop();
  at_rest_ = true;
}

std::optional<Shaper::StraightRun> Shaper::straight_run(const Line& line,
                                                        const AxisValues& tool_offset) {
  if (failed_) return std::nullopt;
  if (find_reach_limit(*kinematics_, line, tool_offset, joints_, scratch_, proven_))
    return std::nullopt;
  if (make_grid(*kinematics_, line, metric_of(line), infinity, tool_offset, limits_, joints_,
                made_))
    return std::nullopt;
  const Grid& grid = made_.grid;
  StraightRun out;
  out.end = made_.ends.q_end;
  const machine::JointVector rate = limits_.j.cwiseQuotient(limits_.a);
  const auto limit = [&](const double* alpha) {
    double a = infinity, j = infinity;
    for (Eigen::Index k = 0; k < rate.size(); ++k) {
      if (alpha[k] == 0) continue;
      a = std::min(a, 1 / std::abs(alpha[k]));
      j = std::min(j, rate[k] / std::abs(alpha[k]));
    }
    out.limits.a = std::min(out.limits.a, a);
    out.limits.j = std::min(out.limits.j, j);
  };
  out.limits = {infinity, limits_.tip_a, infinity};
  for (const GridNode& node : grid.at) out.limits.v = std::min(out.limits.v, std::sqrt(node.cap));
  if (grid.uniform) {
    const machine::JointVector alpha = grid.dq_start.cwiseQuotient(limits_.a);
    limit(alpha.data());
    return out;
  }
  // Where the joints bend along the line, half of each limit is left to the bend.
  double bend = 0;
  for (std::size_t k = 0; k < grid.nodes(); ++k) {
    limit(grid.alpha(k));
    for (int j = 0; j < rate.size(); ++j) bend = std::max(bend, std::abs(grid.beta(k)[j]));
  }
  out.limits.a /= 2;
  out.limits.j /= 2;
  out.limits.v = std::min(out.limits.v, std::sqrt(0.5 / std::max(bend, 1e-300)));
  return out;
}

void Shaper::push_planned(Segment segment, const machine::JointVector& end) {
  if (failed_) return;
  joints_ = end;
  proven_.forget();
  at_rest_ = true;
  chain_.push_still(std::move(segment));
}

// The rest of the pending move up to end_, and the segments behind it.
void Shaper::finish_pending() {
  if (!pending_) return;
  Move move = std::move(*pending_);
  pending_.reset();
  add_range(move, begin_, end_);
  std::vector<Segment> after = std::move(after_);
  after_.clear();
  if (failed_) return;
  for (Segment& still : after) chain_.push_still(std::move(still));
}

// The pending move without its end, then the blend: its first half belongs to the left block, its
// second half to the right one.
void Shaper::add_blend(const Move& left, const Move& right, const CornerBlend& corner) {
  const double middle = corner.blend.length / 2;
  const Path first = sub_path(corner.blend, 0, middle);
  const Path second = sub_path(corner.blend, middle, corner.blend.length);
  const auto half = [](const Move& move, const Path& blend, bool last_part) {
    Segment out = move.segment;
    if (!move.parts.empty())
      out.command = last_part ? move.parts.back().command : move.parts.front().command;
    out.kind = MotionKind::blend;
    out.path = blend;
    return out;
  };
  const auto feeds = [](const Move& move) { return move.segment.kind != MotionKind::rapid; };
  Segment in = half(left, first, true), out = half(right, second, false);
  const double left_length = length(left.segment.path);
  const auto part = [](const Move& move) { return move.segment.u1 - move.segment.u0; };
  in.rounds_feed = out.rounds_feed = feeds(left) || feeds(right);
  in.u0 = in.u1 - part(left) * corner.cut / left_length;
  out.u1 = out.u0 + part(right) * corner.cut / length(right.segment.path);
  const double feed = left.feed;
  const std::optional<KnownRates> known = known_rates(left, right, corner);
  end_ = left_length - corner.cut;
  std::vector<Segment> after = std::move(after_);
  after_.clear();
  finish_pending();
  if (failed_) return;
  const KnownRates* rates = known ? &*known : nullptr;
  add(std::move(in), Metric::xyz, feed, Follows::at_speed, true, rates);
  if (failed_) return;
  for (Segment& still : after) chain_.push_still(std::move(still));
  add(std::move(out), Metric::xyz, right.feed, Follows::same_curve, true, rates);
}

// What is left of a move between two values of its s; a chord goes out line by line.
void Shaper::add_range(Move& move, double begin, double end) {
  const double whole = length(move.segment.path);
  const auto piece = [&](canon::Command command, double low, double high, double from, double to) {
    Segment out = move.segment;
    out.command = std::move(command);
    if (to - from > 1e-12 * whole) {
      out.path = sub_path(move.segment.path, from, to);
      const double u0 = move.segment.u0, part = move.segment.u1 - u0;
      out.u0 = u0 + part * (from - low) / (high - low);
      out.u1 = u0 + part * (to - low) / (high - low);
      add(std::move(out), move.metric, move.feed, Follows::at_speed, from > 0 && to < whole);
    } else if (!move.parts.empty()) {
      // A line that a blend took off whole still reaches the listeners.
      out.path = Hold{evaluate(move.segment.path, std::clamp(high, begin, end)).p};
      out.u0 = out.u1 = 1;
      chain_.push_still(std::move(out));
    }
  };
  if (move.parts.empty()) {
    piece(move.segment.command, 0, whole, begin, end);
    return;
  }
  double low = 0;
  for (Part& part : move.parts) {
    piece(std::move(part.command), low, part.end, std::clamp(low, begin, end),
          std::clamp(part.end, begin, end));
    if (failed_) return;
    for (Segment& still : part.after) chain_.push_still(std::move(still));
    low = part.end;
  }
}

// Gives a piece to the chain, or its good part and the failure.
void Shaper::add(Segment&& segment, Metric metric, double feed, Follows follows, bool passes,
                 const KnownRates* known) {
  const machine::Kinematics& kinematics = *kinematics_;
  const double whole = length(segment.path);
  if (const auto limit = find_reach_limit(kinematics, segment.path, segment.tool_offset, joints_,
                                          scratch_, proven_)) {
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
    const auto problem = make_grid(
        kinematics, segment.path, metric, feed, segment.tool_offset, limits_, joints_, made_,
        at_rest_ || tries > 0 ? Follows::nothing : follows, passes && tries == 0, known);
    if (!problem) {
      append(std::move(segment));
      return;
    }
    const double here = length(segment.path);
    const double good = tries < 8 ? std::min(problem->s, 0.999 * here) : 0;
    const double fraction = segment.u0 + (segment.u1 - segment.u0) * good / here;
    if (!segment.failure || !problem->singular)
      segment.failure = Failure{problem->singular ? "singular" : "unreachable", problem->reason,
                                fraction, evaluate(segment.path, good).p};
    segment.path = sub_path(segment.path, 0, good);
    segment.u1 = fraction;
    failed_ = true;
  }
  // Not even the start of it can be left.
  chain_.stop();
  segment.path = Hold{evaluate(segment.path, 0).p};
  chain_.push_still(std::move(segment));
}

// Squared speed at which a joint can take the jumps of its direction and curvature: by differences
// over the period T they count as jerks |Δq'| v / T² and 3/4 |Δq''| v² / T.
double Shaper::jerk_entry(double scale) const {
  double least = infinity;
  for (Eigen::Index j = 0; j < limits_.j.size(); ++j) {
    if (std::isinf(limits_.j[j])) continue;
    const double kink = std::abs(made_.grid.dq_start[j] - dq_end_[j] / scale);
    const double bend = std::abs(made_.ends.ddq_start[j] - ddq_end_[j] / (scale * scale));
    const double v = kink_jerk_share * limits_.j[j] * period_ * period_ / kink;
    least = std::min({least, v * v, bend_jerk_share * limits_.j[j] * period_ / bend});
  }
  return least;
}

// The piece that make_grid() has looked at.
void Shaper::append(Segment&& segment) {
  const AxisValues& d = made_.ends.d_start;
  const Grid& grid = made_.grid;
  double entry = 0, per_exit = 1;
  if (!at_rest_) {
    const double scale = mixed_norm(d_end_) / mixed_norm(d);  // path speed here per speed before
    per_exit = scale * scale;
    const machine::JointVector jump =
        (grid.dq_start - dq_end_ / scale).cwiseQuotient(limits_.a) / (jump_share * period_);
    const double fastest = 1 / jump.cwiseAbs().maxCoeff();
    entry = std::min(fastest * fastest, jerk_entry(scale));
    // So slow that standing still for a moment costs nothing.
    if (entry < 1e-6 * grid.at.front().cap) entry = 0;
  }
  at_rest_ = false;
  joints_ = made_.ends.q_end;
  d_end_ = made_.ends.d_end;
  dq_end_ = made_.ends.dq_end;
  ddq_end_ = made_.ends.ddq_end;
  chain_.push(std::move(segment), made_.grid, entry, per_exit);
  if (failed_) chain_.stop();
}

}  // namespace aircut::plan
