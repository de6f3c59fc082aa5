#include "report/line_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/json_items.h"
#include "report/messages.h"

namespace aircut::report {
namespace {

constexpr double degrees = 180 / M_PI;

// True when the way counts in degrees: only rotary axes move.
bool turns_only(const plan::Path& path) {
  const auto* line = std::get_if<plan::Line>(&path);
  if (!line) return false;
  constexpr double none = 1e-7;
  for (const Axis axis : all_axes)
    if (!is_rotary(axis) && std::abs(line->end[axis] - line->start[axis]) > none) return false;
  return true;
}

double slowest(const plan::SpeedProfile& profile) {
  double out = std::numeric_limits<double>::infinity();
  for (const plan::ProfileKnot& knot : profile.knots) out = std::min(out, knot.v);
  return out;
}

}  // namespace

Expected<void> LineTimes::write_to(const std::string& path) {
  auto file = OutputFile::create(path);
  if (!file) return unexpected(file.error());
  file_ = std::move(*file);
  return {};
}

std::string LineTimes::cause(const plan::Segment& segment) const {
  if (segment.spindle_from) return "spindle";
  switch (segment.kind) {
    case plan::MotionKind::tool_change:
      return "tool change";
    case plan::MotionKind::dwell:
      return "dwell";
    case plan::MotionKind::sync:
      return "spindle";
    case plan::MotionKind::idle:
      return "wait";
    default:
      break;
  }
  const plan::Cause& by = segment.limited_by;
  if (by.by == plan::LimitedBy::acceleration && by.joint < 0) return "tip acceleration";
  const auto of_joint = [&](const char* what) {
    return by.joint < 0 ? std::string("joint ") + what
                        : machine_.joint(machine::JointId{by.joint}).name + " " + what;
  };
  switch (by.by) {
    case plan::LimitedBy::none:
      return "none";
    case plan::LimitedBy::feed:
      return "feed";
    case plan::LimitedBy::velocity:
      return of_joint("speed");
    case plan::LimitedBy::acceleration:
      return of_joint("acceleration");
    case plan::LimitedBy::jerk:
      return of_joint("jerk");
  }
  return "none";
}

void LineTimes::on_step(const sim::Step& step) {
  const plan::Segment& segment = step.segment;
  if (row_ && row_->block != segment.command.block) write_row();
  const double time = segment.duration();
  const bool moves = plan::length(segment.path) > 0;
  if (!(time > 0) && !moves) return;
  const std::string by = cause(segment);
  held_[by] += time;
  if (!row_) {
    row_.emplace();
    row_->span = segment.command.span;
    row_->block = segment.command.block;
    row_->t0 = segment.t_start;
    row_->min_feed = std::numeric_limits<double>::infinity();
  }
  row_->t1 = segment.t_end();
  row_->held[by] += time;
  if (!moves) return;
  row_->moves = true;
  row_->rotary = turns_only(segment.path);
  row_->length += plan::length(segment.path);
  row_->min_feed = std::min(row_->min_feed, slowest(segment.profile));
}

void LineTimes::write_row() {
  const Row row = std::move(*row_);
  row_.reset();
  if (!file_) return;
  Json out = {{"file", utf8(row.span.text ? row.span.text->name() : "")},
              {"line", row.span.line},
              {"block", row.block},
              {"t0_s", row.t0},
              {"t1_s", row.t1},
              {"time_s", row.t1 - row.t0}};
  if (row.moves) {
    const double unit = row.rotary ? degrees : 1;
    out[row.rotary ? "length_deg" : "length_mm"] = row.length * unit;
    out[row.rotary ? "min_feed_deg_s" : "min_feed_mm_s"] = row.min_feed * unit;
  }
  const auto most =
      std::max_element(row.held.begin(), row.held.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  out["limited_by"] = utf8(most->first);
  file_->write(json_text(out, -1));
}

void LineTimes::on_finish(const sim::Summary&) {
  if (row_) write_row();
  if (file_) result_ = file_->commit();
}

}  // namespace aircut::report
