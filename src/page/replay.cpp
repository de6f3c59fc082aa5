// Idea: every step of the run offers the moments at which its motion bends (its end, and points
// along arcs and along lines of machines whose joints do not move evenly with the path). An offered
// moment waits until a later one shows that the straight line in time from the last kept key misses
// some waiting one by more than the tolerance; then the moment before is kept. When the list is
// full the tolerance doubles and the list goes through the same sieve again.
#include "page/replay.h"

#include <algorithm>
#include <cmath>

namespace aircut::page {
namespace {

constexpr std::size_t most_waiting = 64;
constexpr std::size_t most_blocks = 1'000'000;
constexpr double lever = 100;                        // mm: what a turn by 1 rad is worth
constexpr double least_feed = 2, feed_share = 0.03;  // mm/s and of the feed: by what it may be off
constexpr double same_place = 1e-3;  // mm or rad/lever: a joint that moves less has not turned back

bool is_rapid(const plan::Segment& segment) {
  return std::holds_alternative<canon::Rapid>(segment.command.action);
}

}  // namespace

Replay::Replay(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
               const SourceText& program, std::size_t most_keys)
    : machine_(std::move(machine)),
      tools_(tools),
      program_(&program),
      most_keys_(std::max<std::size_t>(most_keys, 16)) {}

// How many straight lines in time follow the motion between two knots closely: while the speed
// changes by a, such a line over τ is off by a τ² / 8; arcs bend, and the joints of many machines
// do along straight ways too.
int Replay::pieces_between(const plan::Segment& segment, const plan::ProfileKnot& from,
                           const plan::ProfileKnot& to) const {
  if (std::holds_alternative<plan::Hold>(segment.path)) return 1;
  const double a = std::max(std::abs(from.a), std::abs(to.a)), way = to.s - from.s;
  double pieces = (to.t - from.t) * std::sqrt(a / (8 * tolerance_));
  if (const auto* arc = std::get_if<plan::Arc>(&segment.path)) {
    constexpr double chord = 0.05;  // rad
    pieces = std::max(pieces, way / plan::length(segment.path) * std::abs(arc->angle) / chord);
  }
  constexpr double straight = 2;  // mm
  const bool joints = std::holds_alternative<plan::JointWay>(segment.path);
  if (joints || segment.kinematics || machine_->kinematics().type() != "identity")
    pieces = std::max(pieces, way / straight);
  return static_cast<int>(std::clamp(std::ceil(pieces), 1.0, 1000.0));
}

// The line of the program itself; of a block of a sub in another file, that of the call.
std::uint64_t Replay::line_of(const SourceSpan& span) const {
  if (span.text == program_) return span.line;
  for (const CallFrame* frame = span.calls.get(); frame; frame = frame->site.calls.get())
    if (frame->site.text == program_) return frame->site.line;
  return 0;
}

void Replay::on_start(const sim::Scene& scene, const machine::JointVector& joints) {
  Key first;
  first.joints = joints;
  if (const auto tip = machine_->kinematics().forward(joints, {}))
    first.tip = Vec3((*tip)[Axis::x], (*tip)[Axis::y], (*tip)[Axis::z]);
  keys_.push_back(first);
  tool_times_.push_back({0, scene.loaded_tool()});
  const auto n = static_cast<std::size_t>(joints.size());
  for (std::size_t j = 0; j < n; ++j) {
    const double q = joints[static_cast<Eigen::Index>(j)];
    joint_uses_.push_back({q, q, 0, 0});
    turn_at_.push_back(q);
  }
  direction_.assign(n, 0);
}

void Replay::on_step(const sim::Step& step) {
  const plan::Segment& segment = step.segment;
  const std::uint64_t line = line_of(step.span());
  const plan::MotionKind kind = is_rapid(segment) ? plan::MotionKind::rapid : segment.kind;
  if (blocks_.empty() || blocks_.back().line != line || blocks_.back().kind != kind) {
    if (!blocks_.empty() && blocks_.back().t == segment.t_start) blocks_.pop_back();
    if (blocks_.size() < most_blocks)
      blocks_.push_back({segment.t_start, line, kind});
    else
      blocks_left_out_ = true;
  }
  const auto& knots = segment.profile.knots;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double from = knots[k - 1].t, span = knots[k].t - from;
    if (!(span > 0)) continue;
    const int pieces = pieces_between(segment, knots[k - 1], knots[k]);
    for (int i = 1; i <= pieces; ++i) {
      Key key;
      key.t = segment.t_start + from + span * i / pieces;
      rates_.look(step, key.t - span / pieces, key.t);
      const auto state = step.motion.state_at(key.t);
      if (!state) continue;  // the run tells why
      key.joints = state->q;
      const AxisValues tip = step.motion.tip_on_work(state->q, state->tip);
      key.tip = Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]);
      key.feed = state->path_speed;
      key.rapid = is_rapid(segment);
      add(key);
      count(step, key, i == pieces && k + 1 == knots.size());
    }
  }
  const int tool = step.scene.loaded_tool();
  if (tool_times_.back().number != tool) tool_times_.push_back({segment.t_end(), tool});
}

void Replay::on_finish(const sim::Summary&) {
  if (!waiting_.empty()) keep(waiting_.back());
}

double Replay::deviation(const Key& from, const Key& to, const Key& between) const {
  const double share = to.t > from.t ? (between.t - from.t) / (to.t - from.t) : 0;
  double worst = (from.tip + share * (to.tip - from.tip) - between.tip).lpNorm<Eigen::Infinity>();
  for (int j = 0; j < machine_->joint_count(); ++j) {
    const double off = from.joints[j] + share * (to.joints[j] - from.joints[j]) - between.joints[j];
    const bool turns = machine_->joint(machine::JointId{j}).kind == machine::JointKind::rotary;
    worst = std::max(worst, std::abs(off) * (turns ? lever : 1));
  }
  const double feed_off = std::abs(from.feed + share * (to.feed - from.feed) - between.feed);
  return std::max(worst, tolerance_ * feed_off / (least_feed + feed_share * between.feed));
}

void Replay::add(const Key& key) {
  const Key& from = keys_.back();
  const bool other_kind = !waiting_.empty() && waiting_.back().rapid != key.rapid;
  bool misses = other_kind || waiting_.size() >= most_waiting;
  for (std::size_t i = 0; i < waiting_.size() && !misses; ++i)
    misses = deviation(from, key, waiting_[i]) > tolerance_;
  if (misses) {
    const Key last = waiting_.back();
    waiting_.clear();
    keep(last);
  }
  waiting_.push_back(key);
}

void Replay::keep(const Key& key) {
  keys_.push_back(key);
  if (keys_.size() >= most_keys_) thin();
}

void Replay::thin() {
  while (keys_.size() * 4 > most_keys_ * 3) {
    tolerance_ *= 2;
    const bool kinds_count = tolerance_ < 10;  // mm; beyond, even a rapid may be lost
    std::vector<Key> kept = {keys_.front()};
    std::size_t from = 0;
    for (std::size_t i = 2; i < keys_.size(); ++i) {
      bool misses =
          i - from > most_waiting || (kinds_count && keys_[i].rapid != keys_[i - 1].rapid);
      for (std::size_t k = from + 1; k < i && !misses; ++k)
        misses = deviation(keys_[from], keys_[i], keys_[k]) > tolerance_;
      if (!misses) continue;
      from = i - 1;
      kept.push_back(keys_[from]);
    }
    kept.push_back(keys_.back());
    keys_ = std::move(kept);
  }
}

void Replay::count(const sim::Step& step, const Key& end, bool last) {
  for (std::size_t j = 0; j < joint_uses_.size(); ++j) {
    JointUse& use = joint_uses_[j];
    const double q = end.joints[static_cast<Eigen::Index>(j)];
    const Key& before = waiting_.size() > 1 ? waiting_[waiting_.size() - 2] : keys_.back();
    use.distance += std::abs(q - before.joints[static_cast<Eigen::Index>(j)]);
    use.low = std::min(use.low, q);
    use.high = std::max(use.high, q);
    if (std::abs(q - turn_at_[j]) < same_place) continue;
    const int direction = q > turn_at_[j] ? 1 : -1;
    if (direction_[j] != 0 && direction != direction_[j]) ++use.reversals;
    direction_[j] = direction;
    turn_at_[j] = q;
  }
  const plan::Segment& segment = step.segment;
  if (std::holds_alternative<plan::Hold>(segment.path) || !last) return;
  auto use = std::find_if(tool_uses_.begin(), tool_uses_.end(),
                          [&](const ToolUse& u) { return u.number == segment.tool; });
  if (use == tool_uses_.end()) {
    tool_uses_.push_back({segment.tool});
    use = tool_uses_.end() - 1;
    use->first_line = line_of(step.span());
  }
  use->last_line = line_of(step.span());
  if (is_rapid(segment)) {
    use->rapid_time += segment.duration();
  } else {
    use->feed_time += segment.duration();
    use->feed_length += plan::length(segment.path);
    use->max_feed = std::max(use->max_feed, segment.feed);
  }
  use->max_rpm = std::max(use->max_rpm, std::abs(segment.spindle_rpm));
}

std::vector<machine::Body> Replay::tool_bodies(int number) const {
  sim::Scene scene(machine_, tools_);
  const std::size_t own = scene.bodies().size();
  scene.load_tool(number);
  std::vector<machine::Body> out;
  for (std::size_t i = own; i < scene.bodies().size(); ++i) out.push_back(scene.bodies()[i].body);
  return out;
}

}  // namespace aircut::page
