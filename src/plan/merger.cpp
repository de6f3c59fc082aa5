// Naive-CAM merging: a chain of lines becomes its chord while every skipped point is within Q of it
// (distance to the segment) and the points advance along it. Only feed lines of XYZ alone with the
// same feed in continuous mode; at most 100 points. Each line keeps its share of the chord, from
// the projection of its start to that of its end, so times and findings still name the line.
#include "plan/merger.h"

#include <cmath>

namespace aircut::plan {
namespace {

constexpr std::size_t most_points = 100;

Vec3 xyz_of(const AxisValues& p) { return {p[Axis::x], p[Axis::y], p[Axis::z]}; }
const Line& line_of(const Move& move) { return std::get<Line>(move.segment.path); }

bool mergeable(const Move& move) {
  if (move.merge <= 0 || move.mode != canon::PathMode::continuous) return false;
  if (move.segment.kind != MotionKind::feed || !std::holds_alternative<Line>(move.segment.path))
    return false;
  const AxisValues way = line_of(move).end - line_of(move).start;
  for (const Axis axis : all_axes)
    if (index(axis) > index(Axis::z) && way[axis] != 0) return false;
  return move.metric == Metric::xyz;
}

}  // namespace

bool Merger::extends(const Move& move) const {
  const Move& first = group_.front();
  if (group_.size() >= most_points || move.feed != first.feed || move.merge != first.merge ||
      move.tolerance != first.tolerance)
    return false;
  const Vec3 start = xyz_of(line_of(first).start), chord = xyz_of(line_of(move).end) - start;
  const double length2 = chord.squaredNorm();
  if (!(length2 > zero_length * zero_length)) return false;
  double last = 0;
  for (const Move& skipped : group_) {
    const Vec3 way = xyz_of(line_of(skipped).end) - start;
    const double f = way.dot(chord) / length2;
    if (!(f > last) || !(f < 1) || (way - f * chord).norm() > move.merge) return false;
    last = f;
  }
  return true;
}

void Merger::push(Move move) {
  if (!mergeable(move)) {
    release();
    shaper_.push(std::move(move));
    return;
  }
  if (!group_.empty() && !extends(move)) release();
  group_.push_back(std::move(move));
  after_.emplace_back();
}

void Merger::push_still(Segment segment) {
  if (group_.empty())
    shaper_.push_still(std::move(segment));
  else
    after_.back().push_back(std::move(segment));
}

void Merger::stop() {
  release();
  shaper_.stop();
}

void Merger::release() {
  if (group_.empty()) return;
  Move chord = group_.front();
  if (group_.size() > 1) {
    const Line whole = make_line(line_of(group_.front()).start, line_of(group_.back()).end);
    const Vec3 start = xyz_of(whole.start), way = xyz_of(whole.end) - start;
    chord.segment.path = whole;
    chord.segment.merged = true;
    for (std::size_t i = 0; i < group_.size(); ++i) {
      const double f = (xyz_of(line_of(group_[i]).end) - start).dot(way) / way.squaredNorm();
      const bool last = i + 1 == group_.size();
      chord.parts.push_back({std::move(group_[i].segment.command),
                             last ? whole.length : f * whole.length,
                             last ? std::vector<Segment>{} : std::move(after_[i])});
    }
  }
  std::vector<Segment> after = std::move(after_.back());
  group_.clear();
  after_.clear();
  shaper_.push(std::move(chord));
  for (Segment& still : after) shaper_.push_still(std::move(still));
}

}  // namespace aircut::plan
