#include <algorithm>
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
    {Kind::overtravel, "overtravel", Severity::error},
    {Kind::unreachable, "unreachable", Severity::error},
    {Kind::singular, "singular", Severity::error},
    {Kind::tool_missing, "tool_missing", Severity::error},
    {Kind::not_executed, "not_executed", Severity::warning},
    {Kind::not_checked, "not_checked", Severity::warning},
    {Kind::limit_reached, "limit_reached", Severity::warning},
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

Finding finding_at(Kind kind, const Step& step, double t) {
  const plan::Segment& segment = step.segment;
  Finding f;
  f.kind = kind;
  f.severity = severity_of(kind);
  f.span = segment.command.span;
  f.expanded = segment.command.expanded;
  f.tool = step.scene.loaded_tool();
  if (const tool::Tool* tool = step.scene.tool()) f.tool_name = tool->name;
  const int system = std::clamp(segment.work_system, 1, 9);
  f.work_system = work_systems[system - 1];
  f.motion = segment.kind;
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

void Findings::add(Finding finding) {
  if (list_.size() < keep_)
    list_.push_back(std::move(finding));
  else
    ++dropped_;
}

std::vector<Finding> Findings::finish() {
  const auto key = [](const Finding& f) {
    return std::tie(f.t_first, f.kind, f.body_a, f.body_b, f.joint, f.t_end);
  };
  std::stable_sort(list_.begin(), list_.end(),
                   [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
  struct Open {
    double t_end = 0;
    int episode = 0;
  };
  constexpr double same_time = 1e-6;  // s
  std::map<std::tuple<Kind, std::string, std::string, std::string>, Open> open;
  int episodes = 0;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    Finding& f = list_[i];
    f.id = static_cast<int>(i) + 1;
    const auto [place, fresh] = open.try_emplace({f.kind, f.body_a, f.body_b, f.joint});
    Open& episode = place->second;
    if (fresh || f.t_first > episode.t_end + same_time) episode.episode = ++episodes;
    f.episode = episode.episode;
    episode.t_end = std::max(episode.t_end, f.t_end);
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
  if (summary.program_refused || diagnostics.errors() > 0) unknown = true;
  return unknown ? Verdict::unknown : Verdict::pass;
}

}  // namespace aircut::sim
