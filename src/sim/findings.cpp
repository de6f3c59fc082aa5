#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/sim.h"

namespace aircut::sim {

namespace {

struct KindRow {
  Kind kind;
  const char* name;
  Severity severity;
};

constexpr KindRow kinds[] = {
    {Kind::collision, "collision", Severity::error},
    {Kind::near_miss, "near_miss", Severity::warning},
    {Kind::self_overlap, "self_overlap", Severity::error},
    {Kind::tool_change_collision, "tool_change_collision", Severity::error},
    {Kind::probe_contact, "probe_contact", Severity::error},
    {Kind::probe_missed, "probe_missed", Severity::error},
    {Kind::overtravel, "overtravel", Severity::error},
    {Kind::overtravel_margin, "overtravel_margin", Severity::info},
    {Kind::unreachable, "unreachable", Severity::error},
    {Kind::singular, "singular", Severity::error},
    {Kind::axis_unwind, "axis_unwind", Severity::warning},
    {Kind::feed_not_reached, "feed_not_reached", Severity::info},
    {Kind::branch_flip, "branch_flip", Severity::error},
    {Kind::velocity_limit, "velocity_limit", Severity::error},
    {Kind::acceleration_limit, "acceleration_limit", Severity::error},
    {Kind::jerk_limit, "jerk_limit", Severity::error},
    {Kind::path_deviation, "path_deviation", Severity::error},
    {Kind::sync_limit, "sync_limit", Severity::error},
    {Kind::rapid_cut, "rapid_cut", Severity::error},
    {Kind::spindle_stopped_cut, "spindle_stopped_cut", Severity::error},
    {Kind::spindle_direction_cut, "spindle_direction_cut", Severity::error},
    {Kind::no_tool_cut, "no_tool_cut", Severity::error},
    {Kind::plunge_not_center_cutting, "plunge_not_center_cutting", Severity::error},
    {Kind::engagement_limit, "engagement_limit", Severity::warning},
    {Kind::loose_piece, "loose_piece", Severity::warning},
    {Kind::air_cut, "air_cut", Severity::info},
    {Kind::gouge, "gouge", Severity::error},
    {Kind::gouge_live, "gouge_live", Severity::error},
    {Kind::excess, "excess", Severity::warning},
    {Kind::wrong_setup, "wrong_setup", Severity::error},
    {Kind::dynamics_limit, "dynamics_limit", Severity::error},
    {Kind::tool_missing, "tool_missing", Severity::error},
    {Kind::not_executed, "not_executed", Severity::warning},
    {Kind::not_checked, "not_checked", Severity::warning},
    {Kind::spindle_conflict, "spindle_conflict", Severity::error},
    {Kind::axis_conflict, "axis_conflict", Severity::error},
    {Kind::wait_deadlock, "wait_deadlock", Severity::error},
};

const KindRow& row_of(Kind kind) { return kinds[static_cast<std::size_t>(kind)]; }

const char* const work_systems[] = {"G54", "G55",   "G56",   "G57",  "G58",
                                    "G59", "G59.1", "G59.2", "G59.3"};

}  // namespace

std::string_view to_string(Kind kind) { return row_of(kind).name; }
Severity severity_of(Kind kind) { return row_of(kind).severity; }

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::unknown:
      return "unknown";
  }
  return "unknown";
}

std::string work_system_name(int system) {
  return system > 100 ? "G54.1 P" + std::to_string(system - 100)
                      : work_systems[std::clamp(system, 1, 9) - 1];
}

Finding finding_at(Kind kind, const Step& step, double t) {
  const plan::Segment& segment = step.segment;
  Finding f;
  f.kind = kind;
  f.severity = severity_of(kind);
  f.span = segment.command.span;
  f.expanded = segment.command.expanded;
  f.block = segment.command.block;
  f.t_block = segment.t_start;
  f.t_block_end = segment.t_end();
  const std::size_t seat = step.all ? step.channel : 0;
  f.tool = step.scene.loaded_tool(seat);
  if (const tool::Tool* tool = step.scene.tool(seat)) f.tool_name = tool->name;
  if (step.all) {
    f.channel = step.all->names[step.channel];
    f.tools = step.scene.loaded_tools();
  }
  f.work_system = work_system_name(segment.work_system);
  f.motion = segment.kind;
  f.length_offset = step.scene.length_offset();
  f.t_first = f.t_worst = f.t_end = t;
  f.feed = segment.feed;
  f.spindle_rpm = segment.spindle_rpm;
  if (const auto state = step.motion.state_at(t)) {
    f.joints_first = f.joints_worst = state->q;
    f.tip = state->tip;
    f.feed_actual = state->path_speed;
  }
  return f;
}

double fraction_at(const Step& step, double t) {
  const double length = plan::length(step.segment.path);
  const double s = step.segment.profile.at(t - step.segment.t_start).s;
  const double u = length > 0 ? std::clamp(s / length, 0.0, 1.0) : 0;
  return step.segment.u0 + u * (step.segment.u1 - step.segment.u0);
}

namespace {

constexpr double same_time = 1e-6;  // s

// Does `next` go on where `last` ended? A contact lasts; a near miss is a moment, so the parts of
// the blocks in which it was looked for are compared.
bool continues(const Finding& last, const Finding& next) {
  if (next.kind == Kind::gouge || next.kind == Kind::excess) return false;  // places, not times
  if (next.kind == Kind::near_miss && !next.unresolved && !last.unresolved)
    return next.t_block <= last.t_block_end + same_time;
  return next.unresolved == last.unresolved && next.t_first <= last.t_end + same_time;
}

// Cutter in material where it may not be: told of parts of a block that take more than a touch.
bool is_cut(Kind kind) {
  return kind == Kind::rapid_cut || kind == Kind::spindle_stopped_cut ||
         kind == Kind::spindle_direction_cut || kind == Kind::no_tool_cut ||
         kind == Kind::plunge_not_center_cutting || kind == Kind::gouge_live;
}

// The same over blocks: one episode.
bool goes_on(const Finding& last, const Finding& next) {
  return continues(last, next) || (is_cut(next.kind) && next.block <= last.block + 1);
}

// How bad a row is: depth of a contact, excess of a joint.
double badness(const Finding& f) {
  if (f.value && f.limit && f.kind != Kind::near_miss) return std::abs(*f.value - *f.limit);
  return f.depth.value_or(-1e300);
}

void merge(Finding& row, Finding next) {
  if (badness(next) > badness(row)) {
    next.t_first = std::min(row.t_first, next.t_first);
    next.u_first = std::min(row.u_first, next.u_first);
    next.joints_first = row.joints_first;
    next.t_block = row.t_block;
    next.t_end = std::max(row.t_end, next.t_end);
    next.u_end = std::max(row.u_end, next.u_end);
    if (next.kind == Kind::near_miss && !next.unresolved) next.t_first = next.t_end = next.t_worst;
    row = std::move(next);
    return;
  }
  row.t_block_end = next.t_block_end;
  if (row.kind == Kind::near_miss && !row.unresolved) return;
  row.t_end = std::max(row.t_end, next.t_end);
  row.u_end = std::max(row.u_end, next.u_end);
}

}  // namespace

void Findings::add(Finding finding) {
  const auto [place, fresh] = last_.try_emplace(key_of(finding), list_.size());
  if (!fresh) {
    Finding& row = list_[place->second];
    if (row.block == finding.block && continues(row, finding))
      return merge(row, std::move(finding));
  }
  if (list_.size() >= keep_) {
    ++dropped_;
    if (fresh) last_.erase(place);
    return;
  }
  place->second = list_.size();
  list_.push_back(std::move(finding));
}

std::vector<Finding> Findings::finish() {
  const auto key = [](const Finding& f) {
    return std::tie(f.t_first, f.kind, f.body_a, f.body_b, f.joint, f.quantity, f.t_end);
  };
  std::stable_sort(list_.begin(), list_.end(),
                   [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
  struct Open {
    Finding last;
    int episode = 0;
  };
  std::map<Key, Open> open;
  int episodes = 0;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    Finding& f = list_[i];
    f.id = static_cast<int>(i) + 1;
    const auto [place, fresh] = open.try_emplace(key_of(f));
    Open& episode = place->second;
    if (fresh || !goes_on(episode.last, f)) episode.episode = ++episodes;
    f.episode = episode.episode;
    episode.last = f;
  }
  return std::move(list_);
}

Verdict judge(const std::vector<Finding>& findings, const Summary& summary,
              const Diagnostics& diagnostics, std::optional<Severity> fail_on) {
  bool unknown = summary.interrupted || !summary.unchecked.empty() || summary.findings_dropped > 0;
  for (const Finding& f : findings) {
    if (fail_on && f.severity >= *fail_on) return Verdict::fail;
    unknown = unknown || f.makes_unknown || f.unresolved;
  }
  for (const Diagnostic& d : diagnostics.list())
    if (fail_on && d.severity >= *fail_on) return Verdict::fail;
  // A refused block is never a pass, whatever the fail level.
  if (summary.program_refused) unknown = true;
  return unknown ? Verdict::unknown : Verdict::pass;
}

}  // namespace aircut::sim
