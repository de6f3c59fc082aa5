#include "cli/ideal_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aircut::cli {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double infinity = std::numeric_limits<double>::infinity();

logbook::Point point(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }

// Length over a group of three axes.
double length(const AxisValues& way, Axis a, Axis b, Axis c) {
  return std::hypot(way[a], way[b], way[c]);
}

// Weight of control point i at u, by the definition of Cox and de Boor, on the clamped uniform
// knots 0 … 0 1 2 … m … m.
double basis(std::size_t i, std::size_t order, double u, const std::vector<double>& knots) {
  if (order == 1) return knots[i] <= u && u < knots[i + 1] ? 1 : 0;
  const double a = knots[i + order - 1] - knots[i], b = knots[i + order] - knots[i + 1];
  return (a > 0 ? (u - knots[i]) / a * basis(i, order - 1, u, knots) : 0) +
         (b > 0 ? (knots[i + order] - u) / b * basis(i + 1, order - 1, u, knots) : 0);
}

// A spline as a chain of points; `sag`: how far the chain may be off.
std::vector<logbook::Point> chain(const canon::SplineFeed& spline, double z, double& sag) {
  const auto order = static_cast<std::size_t>(spline.order);
  const std::size_t n = spline.points.size();
  std::vector<double> knots;
  for (std::size_t i = 0; i < n + order; ++i)
    knots.push_back(std::clamp(static_cast<double>(i) - static_cast<double>(order) + 1, 0.0,
                               static_cast<double>(n - order + 1)));
  const std::size_t steps = 400 * (n - order + 1);
  std::vector<logbook::Point> out;
  for (std::size_t k = 0; k < steps; ++k) {
    const double u = knots.back() * static_cast<double>(k) / static_cast<double>(steps);
    double x = 0, y = 0, w = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double f = basis(i, order, u, knots) * spline.points[i].weight;
      x += f * spline.points[i].x;
      y += f * spline.points[i].y;
      w += f;
    }
    out.push_back({x / w, y / w, z});
  }
  out.push_back({spline.points.back().x, spline.points.back().y, z});
  // The middle of two chords is off the curve by about a quarter of how far the point between is.
  sag = 0;
  for (std::size_t k = 1; k + 1 < out.size(); ++k)
    sag = std::max(sag, std::hypot(out[k][0] - (out[k - 1][0] + out[k + 1][0]) / 2,
                                   out[k][1] - (out[k - 1][1] + out[k + 1][1]) / 2));
  return out;
}

}  // namespace

IdealPath::IdealPath(interp::Interpreter& interpreter, const AxisValues& start,
                     bool straight_rapids)
    : interpreter_(interpreter), straight_rapids_(straight_rapids), tip_(start) {}

void IdealPath::not_checked(const std::string& what) {
  if (std::find(unchecked_.begin(), unchecked_.end(), what) == unchecked_.end())
    unchecked_.push_back(what);
}

// State that decides on tolerance, feed and where the tip is.
void IdealPath::state(const canon::Command& command) {
  const canon::Action& action = command.action;
  if (const auto* c = std::get_if<canon::SetPathMode>(&action)) {
    blends_ = c->mode == canon::PathMode::continuous;
    tolerance_ = c->tolerance;
  } else if (const auto* naive = std::get_if<canon::SetNaiveCam>(&action)) {
    merge_ = naive->tolerance;
  } else if (const auto* mode = std::get_if<canon::SetFeedMode>(&action)) {
    feed_mode_ = mode->mode;
  } else if (const auto* rate = std::get_if<canon::SetFeedRate>(&action)) {
    rate_ = *rate;
  } else if (const auto* offset = std::get_if<canon::ToolLengthOffset>(&action)) {
    // The machine stands still, so the tip is elsewhere.
    tip_ = tip_ + tool_offset_ - offset->offset;
    tool_offset_ = offset->offset;
  } else if (const auto* speed = std::get_if<canon::SetSpindleSpeed>(&action)) {
    if (speed->spindle == 0) rpm_ = speed->value;
  } else if (const auto* css = std::get_if<canon::SetSpindleMode>(&action)) {
    if (css->spindle == 0) surface_speed_ = css->css_max_rpm > 0;
  }
}

// mm/s or deg/s that F asks for; 0 if that is not known.
double IdealPath::feed(const canon::Command& command, const logbook::IdealPiece& piece,
                       const AxisValues& end) {
  const bool moves = std::holds_alternative<canon::LinearFeed>(command.action) ||
                     std::holds_alternative<canon::ArcFeed>(command.action);
  if (!moves) return 0;
  const AxisValues way = end - tip_;
  constexpr double none = 1e-7;
  const double xyz = length(way, Axis::x, Axis::y, Axis::z);
  const double uvw = length(way, Axis::u, Axis::v, Axis::w);
  const double abc = length(way, Axis::a, Axis::b, Axis::c);
  const bool rotary = !piece.arc && xyz < none && uvw < none;
  switch (feed_mode_) {
    case canon::FeedMode::per_minute:
      return rotary ? rate_.rotary / degree : rate_.value;
    case canon::FeedMode::inverse_time:
      if (piece.arc) {
        not_checked("the feed of arcs in G93 against the program");
        return 0;
      }
      return rate_.value * (rotary ? abc / degree : xyz < none ? uvw : xyz);
    case canon::FeedMode::per_revolution:
      if (surface_speed_) {
        not_checked("the feed per revolution under constant surface speed");
        return 0;
      }
      return rate_.value * std::abs(rpm_) / 60;
  }
  return 0;
}

bool IdealPath::piece(const canon::Command& command, logbook::IdealPiece& out) {
  const AxisValues end = canon::end_of(command.action, tip_);
  out = {};
  out.block = command.block;
  out.line = command.span.line;
  // Without P any way round a corner is right.
  out.tolerance = !blends_ ? 0 : tolerance_ > 0 ? tolerance_ + merge_ : infinity;
  // Straight in the joints: any way there is right.
  if (probed_ || (!straight_rapids_ && std::holds_alternative<canon::Rapid>(command.action)))
    out.tolerance = infinity;
  out.start = point(tip_);
  out.end = point(end);
  if (const auto* arc = std::get_if<canon::ArcFeed>(&command.action); arc && arc->turns != 0) {
    out.arc = true;
    out.centre = {arc->centre.x(), arc->centre.y(), arc->centre.z()};
    out.normal = {arc->normal.x(), arc->normal.y(), arc->normal.z()};
    out.turns = arc->turns;
    if (arc->plane != canon::Plane::xy && arc->plane != canon::Plane::zx &&
        arc->plane != canon::Plane::yz)
      out.arc = false;
  }
  if (const auto* spline = std::get_if<canon::SplineFeed>(&command.action)) {
    double sag = 0;
    out.points = chain(*spline, tip_[Axis::z], sag);
    out.tolerance += sag;
  }
  out.feed = probed_ ? 0 : feed(command, out, end);
  const auto* sync = std::get_if<canon::SyncFeed>(&command.action);
  if (sync && sync->rigid_tap) {
    back_ = out;
    std::swap(back_->start, back_->end);
    return true;  // the tip comes back
  }
  tip_ = end;
  return true;
}

bool IdealPath::next(logbook::IdealPiece& out) {
  if (back_) {
    out = *std::exchange(back_, std::nullopt);
    return true;
  }
  while (const auto command = interpreter_.next()) {
    if (const auto* probe = std::get_if<canon::Probe>(&command->action)) {
      // Where it tripped, if it did, only the model of that run knew.
      if (!probed_)
        not_checked("the path and the feed from the probing move at " + command->span.place() +
                    " on");
      probed_ = true;
      interpreter_.resume({.tip = probe->end, .tripped = false});
    }
    if (std::holds_alternative<canon::SwitchKinematics>(command->action)) {
      not_checked("the path from " + command->span.place() +
                  " on, where the program switches the kinematics");
      return false;
    }
    state(*command);
    if (canon::is_motion(command->action)) return piece(*command, out);
  }
  return false;
}

}  // namespace aircut::cli
