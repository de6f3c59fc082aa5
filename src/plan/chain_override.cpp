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
// Under jerk limits the place of an event is that of the law which the jerk stage would find if the
// event did not come: a copy of the stage is given the pieces of the window to see. There the
// motion can't brake as hard at once: a ramp of the acceleration that lasts r loses as much speed
// as full braking in its second half. So the braking here, which knows no ramps, begins r/2 later,
// and that of the jerk stage at the event.
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

double Chain::now() const { return known_ ? *known_ : jerk_ ? jerk_->time_given() : clock_; }

std::optional<Chain::EventPlace> Chain::find_event() const {
  const double event = overrides_.next();
  if (!jerk_ || std::isinf(event)) return std::nullopt;
  // Pieces up to well behind the event; with jerk limits it only comes earlier on the way.
  const double begin = jerk_->time_given(), enough = event + 2 * jerk_->brake_time() + 0.5;
  std::vector<Ride> rides;
  double b = b_, end = begin;
  for (std::size_t i = 0; i < window_.size() && end < enough && window_[i].factor > 0; ++i) {
    const Item& item = window_[i];
    if (i > 0) b = std::min(entry_of(i, b), item.stop.front());
    rides.push_back(accelerate(item.piece.grid, item.stop, b));
    end += rides.back().profile.duration();
    b = rides.back().b_end;
  }
  constexpr double slower = 10, some = 1;  // s
  const double clock = jerk_->clock();
  if (event > clock + slower * (end - clock) + some) return std::nullopt;

  JerkStage trial = jerk_->trial();
  for (std::size_t i = 0; i < rides.size(); ++i) {
    const Item& item = window_[i];
    Segment segment = item.piece.segment;
    segment.profile = std::move(rides[i].profile);
    segment.feed *= item.factor;
    segment.t_start = static_cast<double>(i + 1);  // its name here
    trial.push(std::move(segment), item.piece.grid, std::sqrt(item.piece.per_exit));
  }
  trial.stop();
  Overrides then = overrides_;
  then.apply(event);
  double t = clock;
  for (const Segment& segment : trial.take()) {
    const bool here = segment.t_start > 0;
    const auto i = here ? static_cast<std::size_t>(segment.t_start) - 1 : 0;
    const bool brakes = here && then.factor(window_[i].piece.segment) < window_[i].factor;
    const double at = event + (brakes ? jerk_->ramp_time() / 2 : 0);
    if (at < t + segment.duration()) {
      if (!here) return EventPlace{0, 0, infinity, begin};  // it has gone on without it
      const auto state = segment.profile.at(std::max(at - t, 0.0));
      return EventPlace{i, state.s, brakes ? state.v : infinity, std::max(at, t)};
    }
    t += segment.duration();
  }
  return std::nullopt;
}

// The front piece goes out up to there.
void Chain::go_until(const EventPlace& place, Ride ride, double factor) {
  double low = 0, high = ride.profile.duration();
  for (int i = 0; i < 100 && low < high; ++i) {
    const double middle = (low + high) / 2;
    (ride.profile.at(middle).s < place.s ? low : high) = middle;
  }
  cut_at(ride, high);
  const std::size_t before = window_.size();
  give_part(std::move(ride), factor);
  if (window_.size() == before) b_ = std::min(b_, place.v * place.v);
  known_ = place.t;
}

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
    known_.reset();
    if (settled && !window_.empty() && window_.front().factor == 0) {
      t = overrides_.next();
      wait_for_event();
      settled = false;
    }
  }
  known_.reset();
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
