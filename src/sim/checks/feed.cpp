// Feed moves that stay far below their F (verification.md §4.2, feed_not_reached).
//
// The speed law of a segment is known piece by piece, v(τ) = v + aτ + jτ²/2. Where it is under half
// of the programmed feed follows from its roots; the way done there is added up over the block,
// which may come as several segments. The blocks that lose most time are told.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/checks/worst_rows.h"

namespace aircut::sim {

namespace {

constexpr double share_of_feed = 0.5;
constexpr double share_of_way = 0.1;
constexpr std::size_t most_rows = 20;

struct Slow {
  double length = 0, time = 0;
};

// Where v + aτ + jτ²/2 crosses `level` inside (0, duration), ascending.
std::vector<double> crossings(const plan::ProfileKnot& k, double level, double duration) {
  std::vector<double> out;
  const double c = k.v - level;
  if (k.j == 0) {
    if (k.a != 0) out.push_back(-c / k.a);
  } else if (const double d = k.a * k.a - 2 * k.j * c; d >= 0) {
    // The root that doesn't cancel first, the other by their product 2c/j.
    const double q = -(k.a + std::copysign(std::sqrt(d), k.a));
    out.push_back(q / k.j);
    if (q != 0) out.push_back(2 * c / q);
  }
  std::erase_if(out, [&](double t) { return !(t > 0 && t < duration); });
  std::sort(out.begin(), out.end());
  return out;
}

double way(const plan::ProfileKnot& k, double t) { return t * (k.v + t * (k.a / 2 + t * k.j / 6)); }

// The way and time of a profile under a speed.
Slow under(const plan::SpeedProfile& profile, double speed) {
  Slow out;
  for (std::size_t i = 0; i + 1 < profile.knots.size(); ++i) {
    const plan::ProfileKnot& k = profile.knots[i];
    const double duration = profile.knots[i + 1].t - k.t;
    std::vector<double> ends = crossings(k, speed, duration);
    ends.push_back(duration);
    double from = 0;
    for (const double to : ends) {
      const double middle = 0.5 * (from + to);
      if (k.v + middle * (k.a + middle * k.j / 2) < speed) {
        out.length += std::max(0.0, way(k, to) - way(k, from));
        out.time += to - from;
      }
      from = to;
    }
  }
  return out;
}

std::string held_by(const plan::Cause& cause, const machine::Machine& machine) {
  const std::string joint =
      cause.joint >= 0 ? " of " + machine.joint(machine::JointId{cause.joint}).name : "";
  switch (cause.by) {
    case plan::LimitedBy::velocity:
      return "the top speed" + joint;
    case plan::LimitedBy::acceleration:
      return "the acceleration" + joint;
    case plan::LimitedBy::jerk:
      return "the jerk" + joint;
    case plan::LimitedBy::feed:
    case plan::LimitedBy::none:
      break;
  }
  return "starting and stopping";
}

class FeedCheck final : public Check {
 public:
  void step(const Step& step, Findings&) override {
    const plan::Segment& segment = step.segment;
    if (segment.command.block != block_) close();
    block_ = segment.command.block;
    const bool feeds = segment.kind == plan::MotionKind::feed ||
                       segment.kind == plan::MotionKind::arc ||
                       segment.kind == plan::MotionKind::blend;
    if (!feeds || !(segment.feed > 0)) return;
    const double length = plan::length(segment.path);
    const Slow slow = under(segment.profile, share_of_feed * segment.feed);
    way_ += length;
    slow_.length += slow.length;
    slow_.time += slow.time;
    lost_ += slow.time - slow.length / segment.feed;
    if (slow.time > 0 && slow.time >= longest_) {
      longest_ = slow.time;
      begin_row(step);
    }
    if (row_) {
      row_->t_end = segment.t_end();
      row_->u_end = segment.u1;
    }
  }

  void finish(Summary&, Findings& out) override {
    close();
    rows_.hand_over("blocks", out);
  }

 private:
  // The row tells of the whole block; the cause is that of its slowest part.
  void begin_row(const Step& step) {
    const bool first = !row_;
    Finding f = finding_at(Kind::feed_not_reached, step, step.segment.t_start);
    if (!first) {
      f.t_first = row_->t_first;
      f.u_first = row_->u_first;
      f.joints_first = row_->joints_first;
    } else {
      f.u_first = step.segment.u0;
    }
    cause_ = held_by(step.segment.limited_by, step.scene.machine());
    row_ = std::move(f);
  }

  void close() {
    if (row_ && slow_.length > share_of_way * way_ && rows_.wants(lost_)) {
      Finding& f = *row_;
      f.value = 100 * slow_.length / way_;
      f.limit = 100 * share_of_way;
      f.unit = "%";
      f.feed_actual = slow_.length / slow_.time;
      f.message = "over " + fixed(*f.value, 0) + " % of this block's " + fixed(way_, 2) +
                  " mm the feed stays under half of F" + shortest(std::round(f.feed * 60)) +
                  ", held by " + cause_;
      f.remedy = "a path tolerance (G64 P) in place of exact stops, longer moves, or a lower F";
      rows_.add(lost_, std::move(f));
    }
    row_.reset();
    slow_ = {};
    way_ = lost_ = longest_ = 0;
  }

  WorstRows rows_{most_rows};
  std::uint64_t block_ = 0;
  double way_ = 0, lost_ = 0, longest_ = 0;  ///< of the block: mm, s, s
  Slow slow_;
  std::optional<Finding> row_;
  std::string cause_;
};

}  // namespace

std::unique_ptr<Check> make_feed_check() { return std::make_unique<FeedCheck>(); }

}  // namespace aircut::sim
