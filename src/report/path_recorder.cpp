#include "report/path_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aircut::report {

namespace {

constexpr double degrees = 180 / M_PI;
constexpr std::size_t most_path_points = 60'000;

render::LineKind line_kind(plan::MotionKind kind) {
  if (kind == plan::MotionKind::rapid) return render::LineKind::rapid;
  if (kind == plan::MotionKind::arc) return render::LineKind::arc;
  return render::LineKind::feed;
}

constexpr int time_steps = 48;

// A ramp that grows evenly lighter, so that it also reads in grey: violet, blue, teal, green,
// yellow.
machine::Color color_at(double share) {
  static constexpr std::array<std::array<int, 3>, 5> stops = {
      {{70, 20, 92}, {58, 82, 150}, {32, 145, 141}, {96, 200, 98}, {245, 222, 50}}};
  const double at = std::clamp(share, 0., 1.) * (stops.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
  const double f = at - static_cast<double>(i);
  const auto mix = [&](std::size_t k) {
    return static_cast<unsigned char>(
        std::lround(stops[i][k] + f * (stops[i + 1][k] - stops[i][k])));
  };
  return {mix(0), mix(1), mix(2)};
}

}  // namespace

void PathRecorder::add(const sim::Step& step) {
  const plan::Segment& segment = step.segment;
  if (std::holds_alternative<plan::Hold>(segment.path) || segment.duration() <= 0) return;
  const double length = plan::length(segment.path);
  const plan::MotionKind kind = std::holds_alternative<canon::Rapid>(segment.command.action)
                                    ? plan::MotionKind::rapid
                                    : segment.kind;
  int pieces = 1;
  if (const auto* arc = std::get_if<plan::Arc>(&segment.path)) {
    constexpr double widest_chord = 6 / degrees;  // rad
    pieces = std::clamp(static_cast<int>(std::ceil(std::abs(arc->angle) / widest_chord)), 2, 720);
  } else if (std::holds_alternative<plan::Blend>(segment.path)) {
    pieces = 6;
  } else if (std::holds_alternative<plan::JointWay>(segment.path)) {
    pieces = 32;
  }
  // Seen from the work, a straight way in other coordinates than the machine's bends.
  if (segment.kinematics) pieces = std::max(pieces, 36);
  for (int i = points_.empty() ? 0 : 1; i <= pieces; ++i) {
    const double t = segment.t_start + segment.duration() * i / pieces;
    const double s = std::min(length, length * i / pieces);
    AxisValues tip = plan::evaluate(segment.path, s).p;
    if (segment.kinematics)
      if (const auto joints = step.motion.at_path(s)) tip = step.motion.tip_on_work(*joints, tip);
    push({Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]), t, kind});
  }
}

std::vector<render::DrawLine> PathRecorder::lines(const Pose& X_WM, double now) const {
  std::vector<render::DrawLine> out;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const render::LineKind kind =
        points_[i].t <= now ? render::LineKind::done : line_kind(points_[i].kind);
    if (out.empty() || out.back().kind != kind) out.push_back({kind, {X_WM * points_[i - 1].p}});
    out.back().points.push_back(X_WM * points_[i].p);
  }
  return out;
}

std::vector<render::DrawLine> PathRecorder::lines_by_time(const Pose& X_WM) const {
  std::vector<render::DrawLine> out;
  const double end = points_.empty() ? 0 : points_.back().t;
  int last = -1;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const int step =
        end > 0 ? std::min(time_steps - 1, static_cast<int>(points_[i].t / end * time_steps)) : 0;
    const render::LineKind kind = line_kind(points_[i].kind);
    if (step != last || out.back().kind != kind)
      out.push_back({kind, {X_WM * points_[i - 1].p}, color_at(step / (time_steps - 1.))});
    last = step;
    out.back().points.push_back(X_WM * points_[i].p);
  }
  return out;
}

std::vector<render::LegendRow> PathRecorder::legend_of_times() const {
  std::vector<render::LegendRow> out;
  const double end = points_.empty() ? 0 : points_.back().t;
  for (const double share : {0., 0.25, 0.5, 0.75, 1.})
    out.push_back({fixed(share * end, end < 10 ? 1 : 0) + " s", color_at(share)});
  return out;
}

Box3 PathRecorder::box(const Pose& X_WM) const {
  Box3 feed, all;
  for (const Point& point : points_) {
    all.extend(X_WM * point.p);
    if (point.kind != plan::MotionKind::rapid) feed.extend(X_WM * point.p);
  }
  return feed.isEmpty() ? all : feed;
}

void PathRecorder::push(const Point& point) {
  if (!points_.empty() && points_.back().kind == point.kind &&
      (points_.back().p - point.p).norm() < spacing_)
    return;
  points_.push_back(point);
  if (points_.size() < most_path_points) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
  points_.resize(kept);
  spacing_ = std::max(0.02, spacing_ * 2);
}

}  // namespace aircut::report
