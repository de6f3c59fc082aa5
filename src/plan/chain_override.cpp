// Overrides and holds. An event comes at a time; the motion is then somewhere on a piece. There the
// piece is cut in two, the speeds that all pieces of the window may have change, and with them
// those that can be braked from. Where the motion is faster than that it brakes as hard as its
// joints allow, along the same path, until it is not:
//
//     speed  ────┐ event                      braking goes on over the ends of pieces; the place
//                 \\                           where it meets the new speed (or rest) cuts the
//                  \\________                  piece once more
//
// The joints' limits never change, and neither does the path. A factor of 0 is a hold: the motion
// waits at rest for the next event.
//
// Under jerk limits the time that is known here is that of the pieces which are final and an
// estimate (without jerk limits) for those that are not, a second or two of motion; and the jerk
// stage begins to brake a little earlier, because it can't brake as hard at once.
#include <cmath>
#include <limits>

#include "plan/chain.h"

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The begin of a ride, `t` long.
void cut_at(Ride& ride, double t) {
  const SpeedProfile::State state = ride.profile.at(t);
  auto& knots = ride.profile.knots;
  while (knots.size() > 1 && knots.back().t >= t) knots.pop_back();
  knots.push_back({t, state.s, state.v, 0, 0});
  ride.b_end = state.v * state.v;
}

// Knots beside the last one, which the cut grid has no node for.
void drop_near_end(Ride& ride, double near) {
  auto& knots = ride.profile.knots;
  const ProfileKnot last = knots.back();
  knots.pop_back();
  while (knots.size() > 1 && knots.back().s >= last.s - near) knots.pop_back();
  knots.push_back(last);
}

}  // namespace

double Chain::now() const { return jerk_ ? jerk_->time_given() : clock_; }

// True if an event comes before the ride ends.
bool Chain::interrupted(const Ride& ride) const {
  return overrides_.next() < now() + ride.profile.duration();
}

void Chain::set_factor(Item& item) {
  const double factor = overrides_.factor(item.piece.segment);
  item.before = std::max(item.before, item.factor);
  if (factor == item.factor) return;
  item.factor = factor;
  scale_caps(item.piece.grid, factor);
}

// A ride over the begin of the front piece goes out; the rest stays.
void Chain::give_part(Ride ride, double factor) {
  if (ride.profile.knots.empty()) return;
  Piece& front = window_.front().piece;
  const double whole = front.grid.length(), near = same_node * whole;
  ProfileKnot& last = ride.profile.knots.back();
  if (last.s >= whole - near) {
    last.s = whole;
    return finish_front(std::move(ride), factor);
  }
  b_ = ride.b_end;
  if (last.s <= near) return;
  const double s = last.s;
  drop_near_end(ride, near);
  Segment part = front.segment;
  part.path = sub_path(front.segment.path, 0, s);
  part.u1 = part.u0 + (part.u1 - part.u0) * s / whole;
  part.failure.reset();
  front.segment.path = sub_path(front.segment.path, s, whole);
  front.segment.u0 = part.u1;
  if (front.segment.trip) *front.segment.trip -= s;
  front.segment.sync_problem.clear();
  Grid begin = grid_before(front.grid, s);
  scale_caps(begin, factor);
  nodes_ -= front.grid.nodes();
  front.grid = grid_behind(front.grid, s);
  nodes_ += front.grid.nodes();
  hand_on(std::move(part), std::move(begin), std::move(ride), front.per_exit, factor);
  front.entry = infinity;
  front.per_exit = 1;
}

void Chain::go_until_event(Ride ride, double factor) {
  const double t = std::max(overrides_.next() - now(), 0.0);
  if (t < ride.profile.duration()) cut_at(ride, t);
  give_part(std::move(ride), factor);
}

// Takes the events up to t, which is now but for rounding, and brakes to what they leave.
void Chain::override_until(double t) {
  bool settled = false;
  while (!settled && !window_.empty()) {
    overrides_.apply(std::max(t, now()));
    for (std::size_t i = 0; i < window_.size(); ++i) set_factor(window_[i]);
    brake_all();
    settled = slow_down(t);
    if (b_ > 0) continue;
    if (jerk_) jerk_->stop();
    drain_jerk_stage();
    if (settled && !window_.empty() && window_.front().factor == 0) {
      t = overrides_.next();
      wait_for_event();
      settled = false;
    }
  }
  for (std::size_t i = 0; i < window_.size(); ++i) window_[i].before = window_[i].factor;
}

// False if the next event comes first, at time t.
bool Chain::slow_down(double& t) {
  while (!window_.empty()) {
    Item& item = window_.front();
    const double factor = std::max(item.before, item.factor);
    // Rounding of the place where both met is no reason to brake on.
    if (b_ <= item.stop.front() * (1 + 1e-9)) {
      b_ = std::min(b_, item.stop.front());
      return true;
    }
    Descent descent = descend(item.piece.grid, item.stop, b_);
    if (interrupted(descent.ride)) {
      t = overrides_.next();
      go_until_event(std::move(descent.ride), factor);
      return false;
    }
    give_part(std::move(descent.ride), factor);
    if (!window_.empty()) brake_all();
  }
  b_ = 0;
  return true;
}

// At rest, held.
void Chain::wait_for_event() {
  const Segment& front = window_.front().piece.segment;
  Segment hold = front;
  hold.kind = MotionKind::idle;
  hold.path = Hold{evaluate(front.path, 0).p};
  hold.u1 = hold.u0;
  hold.failure.reset();
  hold.feed = 0;
  const double seconds = overrides_.next() - now();
  if (seconds > 0 && std::isfinite(seconds))
    hold.profile.knots = {{0, 0, 0, 0, 0}, {seconds, 0, 0, 0, 0}};
  hand_on_still(std::move(hold));
}

}  // namespace aircut::plan
