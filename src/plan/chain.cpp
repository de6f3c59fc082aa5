// Streaming look-ahead. What comes later can only matter through the speed that must still be
// braked. So the backward pass is run twice over the window: once as if the window ended at rest,
// once as if its end could be passed at the best speed there. Both meet where some cap, not the
// end, decides; from there to the left they are the same numbers bit by bit, whatever follows. All
// pieces before the last meeting are final. The result is therefore the same for every size of the
// window that covers the way of braking.
//
// Trying costs a pass over the window; after a try the next comes when the window has doubled, so
// the total is linear in the number of nodes. If the two never meet and the window is full, the
// first half is emitted as the stop-safe pass has it: slower than the optimum, but legal.
#include "plan/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/joint_way.h"

namespace aircut::plan {
namespace {

// Rounded down to 36 bits. The two passes often only tend towards each other; rounding makes them
// the same number once they are that near (a share of 3e-11).
double rounded_down(double b) {
  if (!(b > 0) || std::isinf(b)) return b;
  int exponent = 0;
  const double fraction = std::frexp(b, &exponent);
  return std::ldexp(std::floor(std::ldexp(fraction, 36)), exponent - 36);
}

double entry_speed(const Piece& piece, const Controllable& controllable) {
  return rounded_down(std::min(piece.entry, controllable.front()));
}

}  // namespace

Chain::Chain(std::size_t max_nodes, const machine::Kinematics& kinematics,
             const JointLimits& limits, const machine::JointVector& start, double period,
             std::vector<OverrideEvent> overrides)
    : max_nodes_(max_nodes), limits_(limits), overrides_(std::move(overrides)) {
  if (limits.has_jerk()) jerk_.emplace(kinematics, limits, start, period);
}

void Chain::push(Segment&& segment, Grid& grid, double entry, double per_exit) {
  if (entry <= 0) stop();
  nodes_ += grid.nodes();
  ++all_pieces_;
  all_nodes_ += grid.nodes();
  Item& item = window_.push_back();
  item.piece.segment = std::move(segment);
  std::swap(item.piece.grid, grid);
  item.piece.entry = entry;
  item.piece.per_exit = per_exit;
  item.after.clear();
  item.factor = item.before = 1;
  if (!overrides_.none()) {
    set_factor(item);
    item.before = item.factor;
  }
  if (nodes_ >= next_try_) emit_final();
}

void Chain::push_still(Segment segment) {
  if (!window_.empty()) {
    window_.back().after.push_back(std::move(segment));
  } else {
    hand_on_still(std::move(segment));
    drain_jerk_stage();
  }
}

void Chain::stop() {
  if (window_.empty()) {
    if (jerk_) jerk_->stop();
    drain_jerk_stage();
    return;
  }
  do brake_all();
  while (!emit(window_.size()));
  b_ = 0;
  if (jerk_) jerk_->stop();
  drain_jerk_stage();
}

// Backward pass for a window that ends at rest.
void Chain::brake_all() {
  double b_end = 0;
  for (std::size_t i = window_.size(); i-- > 0;) {
    const Piece& piece = window_[i].piece;
    brake(piece.grid, b_end, window_[i].stop);
    b_end = entry_speed(piece, window_[i].stop) / piece.per_exit;
  }
}

void Chain::emit_final() {
  brake_all();
  double b_fast = std::numeric_limits<double>::infinity();
  std::size_t final_count = 0;
  for (std::size_t i = window_.size(); i-- > 0;) {
    Item& item = window_[i];
    const Piece& piece = item.piece;
    brake(piece.grid, b_fast, item.fast);
    const double fast = entry_speed(piece, item.fast);
    if (fast == entry_speed(piece, item.stop)) {
      final_count = i;
      break;
    }
    b_fast = fast / piece.per_exit;
  }
  if (final_count == 0 && nodes_ > max_nodes_) final_count = window_.size() / 2;
  emit(final_count);  // what an event leaves is looked at again with the next try
  next_try_ = 2 * nodes_ + 512;
  if (nodes_ < max_nodes_) next_try_ = std::min(next_try_, max_nodes_ + 1);
}

// Carries out the first `count` pieces by their stop-safe pass. False when an event came between:
// then the speeds that can be braked from are others.
bool Chain::emit(std::size_t count) {
  const auto place = count > 0 ? find_event() : std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    Item& item = window_.front();
    Ride ride;
    if (item.factor > 0) ride = accelerate(item.piece.grid, item.stop, b_);
    const bool event = jerk_ ? place && place->piece == i : interrupted(ride);
    if (event || item.factor == 0) {
      const double until = event ? overrides_.next() : now();
      if (place && event)
        go_until(*place, std::move(ride), item.factor);
      else
        go_until_event(std::move(ride), item.factor);
      override_until(until);
      drain_jerk_stage();
      return false;
    }
    finish_front(std::move(ride), item.factor);
    if (!window_.empty()) b_ = std::min(b_, window_.front().stop.front());
  }
  drain_jerk_stage();
  return true;
}

// The front piece goes out whole.
void Chain::finish_front(Ride&& ride, double factor) {
  Item& item = window_.front();
  const double b_end = ride.b_end;
  nodes_ -= item.piece.grid.nodes();
  hand_on(std::move(item.piece.segment), std::move(item.piece.grid), std::move(ride),
          item.piece.per_exit, factor);
  for (Segment& still : item.after) hand_on_still(std::move(still));
  window_.pop_front();
  b_ = window_.empty() ? b_end : entry_of(0, b_end);
}

// Squared speed at the start of a piece of the window by that at the end of the piece before it.
double Chain::entry_of(std::size_t i, double b_end) const {
  const Piece& piece = window_[i].piece;
  return std::min(b_end * piece.per_exit, piece.entry);
}

// `factor`: of the speeds, by overrides.
void Chain::hand_on(Segment&& segment, Grid&& grid, Ride&& ride, double per_exit, double factor) {
  segment.profile = std::move(ride.profile);
  segment.limited_by = ride.limited_by;
  segment.feed *= factor;
  if (known_) *known_ += segment.duration();
  segment.spindle_rpm *= overrides_.spindle(segment);
  if (jerk_)
    jerk_->push(std::move(segment), std::move(grid), std::sqrt(per_exit));
  else
    hand_out(std::move(segment));
}

void Chain::hand_on_still(Segment&& segment) {
  // Synchronised motion is planned for the speed that is programmed.
  if (segment.kind != MotionKind::sync) segment.spindle_rpm *= overrides_.spindle(segment);
  if (std::holds_alternative<JointWay>(segment.path) && !overrides_.none())
    override_joint_way(segment, limits_, overrides_, now());
  if (jerk_)
    jerk_->push_still(std::move(segment));
  else
    hand_out(std::move(segment));
}

void Chain::drain_jerk_stage() {
  if (!jerk_) return;
  for (Segment& segment : jerk_->take()) hand_out(std::move(segment));
}

void Chain::hand_out(Segment&& segment) {
  segment.t_start = clock_;
  clock_ += segment.duration();
  turns_ += plan::spindle_turns(segment, segment.duration());
  ready_.push_back(std::move(segment));
}

Statistics Chain::statistics() const {
  Statistics out{all_pieces_, all_nodes_, 0, 0};
  if (jerk_) {
    out.jerk_windows = jerk_->windows();
    out.newton_steps = jerk_->newton_steps();
  }
  return out;
}

std::optional<Segment> Chain::take() {
  if (taken_ == ready_.size()) {
    ready_.clear();
    taken_ = 0;
    return std::nullopt;
  }
  std::optional<Segment> out(std::move(ready_[taken_++]));
  return out;
}

}  // namespace aircut::plan
