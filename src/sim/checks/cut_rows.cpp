#include "sim/checks/cut_rows.h"

#include <algorithm>

namespace aircut::sim {

bool is_rapid(const Step& step) {
  const plan::Segment& segment = step.segment;
  return !segment.rounds_feed &&
         (std::holds_alternative<canon::Rapid>(segment.command.action) ||
          segment.kind == plan::MotionKind::rapid || segment.kind == plan::MotionKind::tool_change);
}

Finding lost_stock(const Step& step, const std::string& why) {
  Finding f = finding_at(Kind::not_checked, step, step.segment.t_start);
  f.message = "from here on it is not known what is left of the stock: " + why;
  f.makes_unknown = true;
  return f;
}

void add_air_cut(const Step& step, Findings& out) {
  const double length = plan::length(step.segment.path);
  Finding f = finding_at(Kind::air_cut, step, step.segment.t_start);
  f.t_end = step.segment.t_end();
  f.u_first = fraction_at(step, f.t_first);
  f.u_end = fraction_at(step, f.t_end);
  f.message = "this feed move of " + fixed(length, 1) + " mm takes no material";
  f.value = length;
  f.limit = longest_air;
  f.unit = "mm";
  out.add(f);
}

Finding cut_row(Kind kind, const Step& step, const StraightMove& move, const Who& who,
                const machine::RawStock& raw, const Vec3& point,
                const std::function<bool(double)>& enough) {
  double low = 0, part = 1;  // by halving
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + part);
    (enough(middle) ? part : low) = middle;
  }
  Finding f = finding_at(kind, step, time_at(step, move.s0 + part * (move.s1 - move.s0)));
  f.t_end = std::max(f.t_first, time_at(step, move.s1));
  f.u_first = fraction_at(step, f.t_first);
  f.u_end = fraction_at(step, f.t_end);
  f.body_a = who.name;
  f.body_b = "stock";
  f.pair = std::string(machine::to_string(who.role)) + "-stock";
  if (f.joints_first.size() > 0) {
    machine::LinkPoses poses;
    machine::forward(step.scene.machine(), f.joints_first, poses);
    f.points = {poses.X_WL[static_cast<std::size_t>(machine::index(raw.link))] * raw.X_LS * point};
  }
  return f;
}

namespace {

std::string name_of(const Who& who) {
  const char* what = who.role == machine::Role::probe   ? "probe `"
                     : who.role == machine::Role::shank ? "tool shank `"
                                                        : "tool holder `";
  return what + who.name + "`";
}

}  // namespace

void tell_hit(Finding& row, const Who& who, std::optional<double> depth_bound,
              const std::string& remedy) {
  row.message = name_of(who) + (who.role == machine::Role::probe
                                    ? " touches the stock"
                                    : " runs into stock that the cutter leaves standing");
  row.depth_bound = depth_bound;
  row.remedy = remedy;
}

void tell_doubt(Finding& row, const Who& who, double pitch) {
  row.message = name_of(who) +
                " may touch stock: neither contact nor clearance could be proven with a " +
                shortest(pitch) + " mm lattice";
  row.remedy = "a smaller [stock] pitch in the set-up decides it";
  row.unresolved = row.makes_unknown = true;
}

void CutRows::tell(Finding f, std::optional<double> depth, double volume) {
  auto at = std::find_if(rows_.begin(), rows_.end(), [&](const Finding& other) {
    return other.kind == f.kind && other.body_a == f.body_a;
  });
  if (at == rows_.end()) {
    at = rows_.insert(at, std::move(f));
  } else {
    at->t_end = f.t_end;
    at->u_end = f.u_end;
    if (depth.value_or(0) > at->depth.value_or(0)) at->points = f.points;
  }
  if (at->value) *at->value += volume;
  if (depth && !at->unresolved) at->depth = std::max(at->depth.value_or(0), *depth);
}

void CutRows::hand_over(Findings& out) {
  for (Finding& f : rows_) {
    if (f.value && f.unit == "mm3" && f.kind != Kind::no_tool_cut)
      f.message += ": " + fixed(*f.value, *f.value < 10 ? 2 : 0) + " mm³ in its way";
    out.add(std::move(f));
  }
  rows_.clear();
}

}  // namespace aircut::sim
