// Nothing is kept of a stretch but what the summaries take from it.
#include "process/tally.h"

#include <algorithm>
#include <cmath>

namespace aircut::process {

using namespace accuracy;

namespace {

constexpr double doubtful_share = 0.1;  // of the depth: displacements beyond are no small ones

}  // namespace

void Track::add(double x, double y) {
  if (waiting_ > 0 && waiting_ < stride_) {
    ++waiting_;
    if (std::abs(y) > std::abs(points_.back().second)) points_.back() = {x, y};
    return;
  }
  waiting_ = 1;
  points_.emplace_back(x, y);
  if (points_.size() < most) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < points_.size(); i += 2)
    points_[kept++] = std::abs(points_[i].second) >= std::abs(points_[i + 1].second)
                          ? points_[i]
                          : points_[i + 1];
  points_.resize(kept);
  stride_ *= 2;
}

Tally::Tally(const Setup& setup, Remarks& remarks) : setup_(setup), remarks_(remarks) {
  tools_.resize(setup.tools.size());
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].tool = i;
    tools_[i].shares.assign(setup.bodies.size(), 0);
  }
  for (const Dimension& size : setup.dimensions) sizes_.emplace_back(size.tools.size());
}

void Tally::add(const Engaged& engaged, const Answer& found, const std::vector<int>& sides) {
  const sim::Cut& cut = *engaged.cut;
  const CutContact& contact = engaged.contact;
  const std::size_t tool = engaged.tool;
  ToolSummary& sum = tools_[tool];
  const double time = cut.t1 - cut.t0;
  if (cut.t0 > t_end_ + 1e-6) {  // nothing was cut in between
    for (ToolSummary& one : tools_)
      if (one.stretches > 0) one.over_time.add(t_end_, 0);
    sum.over_time.add(cut.t0, 0);
  }
  t_end_ = std::max(t_end_, cut.t1);
  ++sum.stretches;
  sum.time += time;
  sum.volume += cut.volume;
  sum.mean += time * found.delta;
  const double um = found.delta * 1e3;
  sum.over_time.add(0.5 * (cut.t0 + cut.t1), um);
  sum.over_way.add(way_ + cut.way / 2, um);
  way_ += cut.way;
  const Limits& limits = setup_.limits;
  const auto offer = [&](Worst& worst, double value, const std::optional<double>& limit) {
    worst.offer(value, cut);
    if (limit && value > *limit) ++worst.over;
  };
  offer(sum.force, found.P_cut, limits.cut_force);
  offer(sum.power, found.power, limits.power_kW);
  const auto torque =
      limits.torque_Nm ? std::optional(*limits.torque_Nm * 1e3) : std::optional<double>();
  offer(sum.torque, found.torque, torque);
  offer(sum.chip, contact.chip, limits.chip);
  const double moved = found.moved.displacement.norm();
  offer(sum.deflection, moved, limits.deflection);
  if (sum.stretches == 1) sum.most.value = found.delta, sum.least.value = -found.delta;
  sum.most.offer(found.delta, cut);
  sum.least.offer(-found.delta, cut);
  for (std::size_t b = 0; b < sum.shares.size(); ++b) sum.shares[b] += time * found.shares[b];
  if (contact.t > 0 && moved > doubtful_share * contact.t)
    remarks_.say("displacement_large", tool, cut.span,
                 "the displacement of " + name(tool) +
                     " is more than a tenth of its depth: the model is linear and hardly holds");
  if (std::all_of(sides.begin(), sides.end(), [](int s) { return s == 0; }))
    remarks_.say("no_relative_compliance", tool, cut.span,
                 "nothing gives way between " + name(tool) + " and the work");
  if (const auto& law = contact.material->turning; law && cut.turned) {
    const auto warn = [&](const char* what, const std::optional<Interval>& valid, double value) {
      if (valid && !valid->holds(value))
        remarks_.say("law_extrapolated", tool, cut.span,
                     std::string(what) + " of " + name(tool) + " leaves " + shortest(valid->low) +
                         " … " + shortest(valid->high) + ", where its law was measured");
    };
    warn("the depth", law->valid_t, contact.t);
    warn("the feed", law->valid_S, contact.S);
    warn("the speed", law->valid_V, contact.V);
  }
  add_sizes(engaged, found);
}

void Tally::add_sizes(const Engaged& engaged, const Answer& found) {
  const sim::Cut& cut = *engaged.cut;
  const CutContact& contact = engaged.contact;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    const Dimension& asked = setup_.dimensions[i];
    const auto line = static_cast<double>(cut.span.line);
    if (asked.lines && !asked.lines->holds(line)) continue;
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      if (const auto& range = asked.at[static_cast<std::size_t>(a)])
        inside = inside && range->holds(cut.point[a]);
    if (!inside) continue;
    for (std::size_t k = 0; k < asked.tools.size(); ++k) {
      if (asked.tools[k] != engaged.tool) continue;
      const bool floor = asked.kind == SizeKind::length && !contact.floor.isZero();
      const double error = size_error(asked.kind, floor ? found.floor : found.delta);
      const double factor = size_error(asked.kind, 1), time = cut.t1 - cut.t0;
      Field field = found.field.value_or(Field{});
      double low = factor * field.low, high = factor * field.high;
      if (low > high) std::swap(low, high);
      if (floor) low = high = error;
      SizeTool& sum = sizes_[i][k];
      const bool first = sum.time == 0;
      sum.least = first ? error : std::min(sum.least, error);
      sum.most = first ? error : std::max(sum.most, error);
      sum.low = first ? low : std::min(sum.low, low);
      sum.high = first ? high : std::max(sum.high, high);
      sum.sum += error * time;
      sum.time += time;
      if (first || field.width() > sum.widest.width()) sum.widest = field;
      if (std::abs(error) > sum.largest) {
        sum.largest = std::abs(error);
        sum.span = cut.span;
      }
    }
  }
}

void Tally::tell_limits(const ToolSummary& tool, Diagnostics& out) const {
  const Limits& limits = setup_.limits;
  const auto tell = [&](const char* kind, const Worst& worst, const char* what, double limit,
                        double unit, const char* unit_name) {
    if (worst.over == 0) return;
    Diagnostic d = make_error(
        kind, worst.span,
        std::string(what) + " of " + name(tool.tool) + " is " + fixed(worst.value * unit, 3) + " " +
            unit_name + " here, the limit is " + fixed(limit * unit, 3) + " " + unit_name);
    d.notes.push_back({"note", "t = " + fixed(worst.t, 3) + " s; over it in " +
                                   std::to_string(worst.over) + " of " +
                                   std::to_string(tool.stretches) + " stretches"});
    out.add(std::move(d));
  };
  if (limits.cut_force)
    tell("force_limit", tool.force, "the cutting force", *limits.cut_force, 1, "N");
  if (limits.power_kW)
    tell("power_limit", tool.power, "the power at the motor", *limits.power_kW, 1, "kW");
  if (limits.torque_Nm)
    tell("torque_limit", tool.torque, "the torque", *limits.torque_Nm * 1e3, 1e-3, "N·m");
  if (limits.chip) tell("chip_load", tool.chip, "the chip's thickness", *limits.chip, 1, "mm");
  if (limits.deflection)
    tell("deflection", tool.deflection, "the displacement against the work", *limits.deflection,
         1e3, "µm");
}

// Two tools of a width add their errors; each may be anywhere in its own range.
DimensionResult Tally::dimension(std::size_t index, Diagnostics& out) {
  const Dimension& asked = setup_.dimensions[index];
  DimensionResult result;
  SourceSpan place = asked.place;
  double largest = -1;
  for (std::size_t k = 0; k < sizes_[index].size(); ++k) {
    const SizeTool& tool = sizes_[index][k];
    if (tool.time == 0) {
      result.unchecked = name(asked.tools[k]) + " cuts nothing of it";
      return result;
    }
    result.least += tool.least;
    result.most += tool.most;
    result.mean += tool.sum / tool.time;
    const Field before = result.field;
    if (k == 0 || tool.widest.width() > before.width()) result.field = tool.widest;
    result.field.low = before.low * (k > 0) + tool.low;
    result.field.high = before.high * (k > 0) + tool.high;
    if (tool.largest > largest) place = tool.span;
    largest = std::max(largest, tool.largest);
  }
  judge(asked, place, result, out);
  return result;
}

Summary Tally::finish(Diagnostics& out) {
  Summary sum;
  for (ToolSummary& tool : tools_) {
    if (tool.stretches == 0) continue;
    tool.over_time.add(t_end_, 0);
    tool.mean /= tool.time;
    for (double& share : tool.shares) share /= tool.time;
    tool.least.value = -tool.least.value;
    tell_limits(tool, out);
    sum.stretches += tool.stretches;
    sum.tools.push_back(tool);
    const ToolEntry& entry = setup_.tools[tool.tool];
    const auto law =
        setup_.materials.find(entry.law.empty() ? setup_.works[0].material : entry.law);
    if (law != setup_.materials.end() &&
        std::find(sum.sources.begin(), sum.sources.end(), law->second.source) == sum.sources.end())
      sum.sources.push_back(law->second.source);
  }
  for (const Remark& said : remarks_.list()) {
    const std::string often =
        said.count > 1 ? " (" + std::to_string(said.count) + " stretches from here on)" : "";
    if (said.severity == Severity::error)
      out.error(said.kind, said.span, said.text + often);
    else
      out.warning(said.kind, said.span, said.text + often);
    if (said.kind == "force_unknown" || said.kind == "copying_not_converged")
      sum.unchecked.push_back("the accuracy: " + said.text);
  }
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sum.dimensions.push_back(dimension(i, out));
    const DimensionResult& result = sum.dimensions.back();
    if (!result.unchecked.empty())
      sum.unchecked.push_back("the size '" + setup_.dimensions[i].name + "': " + result.unchecked);
  }
  if (setup_.scatter.independent_bodies || setup_.scatter.draws)
    sum.unchecked.push_back(
        "the scatter: 'independent_bodies' and 'monte_carlo' are for a set-up without a program");
  return sum;
}

}  // namespace aircut::process
