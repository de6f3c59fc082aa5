// The planned path against the programmed one (verification.md §4.2, path_deviation).
//
// Of every command the ideal path is kept for a while. A segment's path is compared with it at its
// ends, and between them where it is a corner's blend or replaces several lines: there it may lie
// nearer to a neighbour's path, also to one that is not known yet, so such places wait until a path
// comes that they lie on. What G64 P and Q allow is allowed; G64 without P allows everything.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "sim/checks/worst_rows.h"

namespace aircut::sim {

namespace {

constexpr double rounding = 1e-6;    // mm
constexpr std::size_t around = 120;  // paths before and behind: a merged chord replaces up to 100
constexpr std::size_t most_rows = 20;

Vec3 xyz(const AxisValues& v) { return Vec3(v[Axis::x], v[Axis::y], v[Axis::z]); }

double distance_to(const plan::Line& line, const Vec3& p) {
  const Vec3 start = xyz(line.start), way = xyz(line.end) - start;
  const double square = way.squaredNorm();
  const double f = square > 0 ? std::clamp((p - start).dot(way) / square, 0.0, 1.0) : 0;
  return (start + f * way - p).norm();
}

// By the angle there is one place per turn; the nearest is found about it by golden section.
double distance_to(const plan::Arc& arc, const Vec3& p) {
  const auto at = [&](double angle) {
    const double f = std::clamp(angle / arc.angle, 0.0, 1.0);
    return (xyz(plan::evaluate(arc, f * arc.length).p) - p).norm();
  };
  const Vec3 from = p - arc.centre;
  const double first = std::atan2(from.dot(arc.normal.cross(arc.radial)), from.dot(arc.radial));
  const double low = std::min(0.0, arc.angle), high = std::max(0.0, arc.angle);
  double best = std::min(at(0), at(arc.angle));
  for (double angle = first + 2 * M_PI * std::floor((low - first) / (2 * M_PI));
       angle <= high + 2 * M_PI; angle += 2 * M_PI) {
    double a = std::clamp(angle - 0.2, low, high), b = std::clamp(angle + 0.2, low, high);
    while (b - a > 1e-9) {
      const double m = a + 0.382 * (b - a), n = a + 0.618 * (b - a);
      if (at(m) < at(n))
        b = n;
      else
        a = m;
    }
    best = std::min(best, at((a + b) / 2));
  }
  return best;
}

double distance_to(const plan::Path& path, const Vec3& p) {
  if (const auto* line = std::get_if<plan::Line>(&path)) return distance_to(*line, p);
  if (const auto* arc = std::get_if<plan::Arc>(&path)) return distance_to(*arc, p);
  return std::numeric_limits<double>::infinity();
}

class DeviationCheck final : public Check {
 public:
  void step(const Step& step, Findings&) override {
    const plan::Segment& segment = step.segment;
    const canon::Action& action = segment.command.action;
    if (const auto* mode = std::get_if<canon::SetPathMode>(&action)) {
      before_ = count_ > 0 ? corner_ : 0;
      fresh_ = true;
      corner_ = mode->mode != canon::PathMode::continuous ? 0
                : mode->tolerance > 0                     ? mode->tolerance
                                                          : std::numeric_limits<double>::infinity();
    }
    if (const auto* cam = std::get_if<canon::SetNaiveCam>(&action)) {
      cam_before_ = count_ > 0 ? cam_ : 0;
      fresh_ = true;
      cam_ = cam->tolerance;
    }
    // The tip is another one.
    if (segment.tool_offset != offset_ || segment.kinematics != kinematics_) start_.reset();
    offset_ = segment.tool_offset;
    kinematics_ = segment.kinematics;
    if (!canon::is_motion(action) || std::holds_alternative<plan::Hold>(segment.path)) return;
    begin_command(segment, action);
    look_at(step);
    if (segment.failure) start_.reset();
  }

  void finish(Summary&, Findings& out) override {
    judge_waiting(true);
    rows_.hand_over("places", out);
  }

 private:
  /// Splines, probing and tapping go and end where the planner says: nothing to compare with.
  struct Ideal {
    plan::Path path;
    bool known = false;
  };
  struct Place {
    Vec3 p;
    double t = 0, nearest = 0;
  };
  struct Waiting {
    Finding row;
    std::vector<Place> places;
    double allowed = 0;
    std::size_t own = 0, seen = 0;  ///< running numbers of ideal paths
  };

  void begin_command(const plan::Segment& segment, const canon::Action& action) {
    // A hold at a block's start splits off a part of no length.
    const bool begins = segment.u0 == 0 && !at_its_start_;
    at_its_start_ = segment.u0 == 0 && segment.u1 == 0;
    if (!begins && count_ > 0) return;
    const AxisValues start = start_ ? *start_ : plan::evaluate(segment.path, 0).p;
    auto path = plan::path_of(start, action);
    const bool plain = std::holds_alternative<canon::Rapid>(action) ||
                       std::holds_alternative<canon::LinearFeed>(action) ||
                       std::holds_alternative<canon::ArcFeed>(action);
    start_.reset();
    if (path && plain) start_ = plan::evaluate(*path, plan::length(*path)).p;
    Ideal ideal;
    ideal.known = path && plain;
    if (ideal.known) ideal.path = std::move(*path);
    ideals_.push_back(std::move(ideal));
    ++count_;
    if (!std::exchange(fresh_, false))
      before_ = cam_before_ = 0;  // its start may still be rounded by the old mode
    judge_waiting(false);
    if (ideals_.size() > 2 * around) ideals_.pop_front();
  }

  void look_at(const Step& step) {
    const plan::Segment& segment = step.segment;
    const bool rounds = std::holds_alternative<plan::Blend>(segment.path);
    const bool free = rounds || segment.merged;
    const double allowed =
        rounding + (free ? std::max(corner_, before_) + std::max(cam_, cam_before_) : 0);
    if (std::isinf(allowed) || !ideals_.back().known) return;
    const double length = plan::length(segment.path);
    const int parts = free || std::holds_alternative<plan::Arc>(segment.path) ? 4 : 1;
    Waiting w;
    for (int i = 0; i <= parts; ++i) {
      const Vec3 p = xyz(plan::evaluate(segment.path, length * i / parts).p);
      const double off = distance_to(ideals_.back().path, p);
      if (off > allowed) w.places.push_back({p, fraction_time(segment, length * i / parts), off});
    }
    if (w.places.empty()) return;
    w.row = finding_at(Kind::path_deviation, step, segment.t_start);
    w.row.t_end = segment.t_end();
    w.allowed = allowed;
    w.own = w.seen = count_;
    // A path before it may be the nearer one.
    for (std::size_t i = ideals_.size() - 1; free && i-- > 0 && !w.places.empty();)
      take_near(w, ideals_[i], i + 2 == ideals_.size());
    if (w.places.empty()) return;
    if (free)
      waiting_.push_back(std::move(w));
    else
      tell(std::move(w));
  }

  static double fraction_time(const plan::Segment& segment, double s) {
    double a = 0, b = segment.duration();
    for (int i = 0; i < 50; ++i) {
      const double m = (a + b) / 2;
      (segment.profile.at(m).s < s ? a : b) = m;
    }
    return segment.t_start + b;
  }

  static void take_near(Waiting& w, const Ideal& ideal, bool adjacent) {
    if (!ideal.known && adjacent) w.places.clear();  // rounded into something unknown
    std::erase_if(w.places, [&](Place& place) {
      place.nearest = std::min(place.nearest, distance_to(ideal.path, place.p));
      return place.nearest <= w.allowed;
    });
  }

  void judge_waiting(bool last) {
    std::erase_if(waiting_, [&](Waiting& w) {
      if (!last) {
        take_near(w, ideals_.back(), w.seen == w.own);
        ++w.seen;
      }
      if (w.places.empty()) return true;
      if (!last && w.seen < w.own + around) return false;
      tell(std::move(w));
      return true;
    });
  }

  void tell(Waiting w) {
    const auto worst =
        std::max_element(w.places.begin(), w.places.end(),
                         [](const Place& a, const Place& b) { return a.nearest < b.nearest; });
    if (!rows_.wants(worst->nearest)) return;
    Finding f = std::move(w.row);
    f.t_worst = worst->t;
    f.value = worst->nearest;
    f.limit = w.allowed - rounding;
    f.unit = "mm";
    f.message = "the planned path is " + fixed(*f.value, 4) +
                " mm off the programmed one, allowed are " + shortest(*f.limit) + " mm";
    f.remedy = "this is a fault of the planned motion: report it with the program and the machine";
    rows_.add(worst->nearest, std::move(f));
  }

  // Unless told otherwise the control rounds corners as it likes.
  double corner_ = std::numeric_limits<double>::infinity(), before_ = 0;  ///< G64 P, mm
  double cam_ = 0, cam_before_ = 0;                                       ///< G64 Q, mm
  AxisValues offset_;
  const machine::Kinematics* kinematics_ = nullptr;
  std::optional<AxisValues> start_;  ///< of the next command
  bool at_its_start_ = false;
  bool fresh_ = false;  ///< no command came since the mode changed
  std::deque<Ideal> ideals_;
  std::size_t count_ = 0;  ///< ideal paths so far
  std::vector<Waiting> waiting_;
  WorstRows rows_{most_rows};
};

}  // namespace

std::unique_ptr<Check> make_deviation_check() { return std::make_unique<DeviationCheck>(); }

}  // namespace aircut::sim
