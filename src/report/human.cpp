#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "report/accuracy_along.h"
#include "report/messages.h"

namespace aircut::report {

namespace {

constexpr double degrees = 180 / M_PI;

std::string joints_text(const machine::JointVector& q, const RunReport& report) {
  std::string out;
  for (int j = 0; j < q.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (i >= report.joint_names.size()) break;
    if (!out.empty()) out += "  ";
    out += report.joint_names[i] + " " + fixed(report.joint_rotary[i] ? q[j] * degrees : q[j], 3);
  }
  return out;
}

std::string seconds(double t) { return fixed(t, 3) + " s"; }

// 1:02:03.4, as a machinist reads a cycle time.
std::string clock(double t) {
  const auto tenths = static_cast<long long>(std::llround(t * 10));
  const long long h = tenths / 36000, m = tenths / 600 % 60, s = tenths / 10 % 60;
  const auto two = [](long long v) { return (v < 10 ? "0" : "") + std::to_string(v); };
  return (h > 0 ? std::to_string(h) + ":" : "") + (h > 0 ? two(m) : std::to_string(m)) + ":" +
         two(s) + "." + std::to_string(tenths % 10);
}

std::string plural(std::uint64_t n, const std::string& word) {
  return std::to_string(n) + " " + word + (n == 1 ? "" : "s");
}

// A share in percent; 100 % only if it is all of it.
std::string percent(double share) {
  if (share >= 1) return "100 %";
  if (share > 0 && share < 0.0001) return "below 0.01 %";
  if (share <= 0) return "0 %";
  return fixed(std::min(share * 100, 99.99), 2) + " %";
}

std::string underline_remark(const sim::Finding& f) {
  const auto whole = [](double u) { return fixed(u * 100, 0); };
  switch (f.kind) {
    case sim::Kind::collision:
    case sim::Kind::probe_contact:
      return "contact from " + whole(f.u_first) + " % to " + whole(f.u_end) +
             " % of this move, t = " + fixed(f.t_first, 3) + " … " + seconds(f.t_end);
    case sim::Kind::near_miss:
      return "nearest at " + whole(f.u_first) + " % of this move, t = " + seconds(f.t_first);
    case sim::Kind::rapid_cut:
    case sim::Kind::spindle_stopped_cut:
    case sim::Kind::spindle_direction_cut:
    case sim::Kind::no_tool_cut:
    case sim::Kind::gouge_live:
    case sim::Kind::plunge_not_center_cutting:
      return "from " + whole(f.u_first) + " % of this move on, t = " + seconds(f.t_first);
    case sim::Kind::overtravel_margin:
      return "from " + whole(f.u_first) + " % of this move on, t = " + seconds(f.t_first);
    case sim::Kind::overtravel:
      return "outside from " + whole(f.u_first) + " % to " + whole(f.u_end) +
             " % of this move, t = " + fixed(f.t_first, 3) + " … " + seconds(f.t_end);
    case sim::Kind::unreachable:
    case sim::Kind::singular:
      return "from " + fixed(f.u_first * 100, 1) + " % of this move on, t = " + seconds(f.t_first);
    case sim::Kind::self_overlap:
    case sim::Kind::tool_change_collision:
    case sim::Kind::probe_missed:
    case sim::Kind::axis_unwind:
    case sim::Kind::feed_not_reached:
    case sim::Kind::branch_flip:
    case sim::Kind::velocity_limit:
    case sim::Kind::acceleration_limit:
    case sim::Kind::jerk_limit:
    case sim::Kind::path_deviation:
    case sim::Kind::engagement_limit:
    case sim::Kind::loose_piece:
    case sim::Kind::sync_limit:
    case sim::Kind::air_cut:
    case sim::Kind::dynamics_limit:
    case sim::Kind::gouge:
    case sim::Kind::tool_missing:
    case sim::Kind::not_executed:
    case sim::Kind::not_checked:
    case sim::Kind::spindle_conflict:
    case sim::Kind::axis_conflict:
    case sim::Kind::wait_deadlock:
      return "t = " + seconds(f.t_first);
    case sim::Kind::excess:
    case sim::Kind::wrong_setup:
      return {};  // of no moment
  }
  return {};
}

const char* verdict_paint(sim::Verdict verdict) {
  switch (verdict) {
    case sim::Verdict::pass:
      return "\x1b[1;32m";
    case sim::Verdict::fail:
      return "\x1b[1;31m";
    case sim::Verdict::unknown:
      return "\x1b[1;33m";
  }
  return "";
}

// Many programs: how many of each verdict.
std::string programs_text(const RunReport& report) {
  std::size_t counts[3] = {};
  for (const Unit& unit : report.units) ++counts[static_cast<std::size_t>(unit.verdict)];
  std::string out = "  programs " + std::to_string(report.units.size()) + ": ";
  bool first = true;
  for (const sim::Verdict v : {sim::Verdict::pass, sim::Verdict::fail, sim::Verdict::unknown}) {
    const std::size_t n = counts[static_cast<std::size_t>(v)];
    if (n == 0) continue;
    out += (first ? "" : ", ") + std::to_string(n) + " " + std::string(sim::to_string(v));
    first = false;
  }
  return out + "; ";
}

// What a waiver or the baseline has accepted, so that nobody takes a pass for more than it is.
std::string accepted_text(const RunReport& report, std::size_t most) {
  std::string out;
  std::size_t waived = 0, old = 0;
  for (const Accepted& a : report.accepted) {
    if (a.baseline) {
      ++old;
    } else if (++waived <= most) {
      const std::string at = a.message.span ? a.message.span.place() + ": " : std::string();
      out += "  - " + printable(at + a.message.kind + ": " + a.message.message) +
             "\n    waived: " + printable(a.reason) + "\n";
    }
  }
  if (waived > most) out += "  - … and " + std::to_string(waived - most) + " more\n";
  if (old > 0) out += "  - " + plural(old, "finding") + " of the baseline\n";
  if (report.baseline_gone && *report.baseline_gone > 0)
    out += "  - " + plural(*report.baseline_gone, "finding") + " of the baseline " +
           (*report.baseline_gone == 1 ? "is" : "are") + " gone\n";
  return out.empty() ? out : "accepted:\n" + out + "\n";
}

// The time by operation, where there are several; what a loop does again is one line.
std::string operations_text(const RunReport& report) {
  constexpr std::size_t most = 12;
  if (report.operations.size() < 2) return {};
  struct Row {
    const Operation* first = nullptr;
    double time = 0;
    std::size_t times = 0;
  };
  std::vector<Row> rows;
  std::map<std::tuple<int, std::uint64_t, std::string>, std::size_t> place;
  for (const Operation& o : report.operations) {
    const auto [at, fresh] = place.try_emplace({o.tool, o.line, o.name}, rows.size());
    if (fresh) rows.push_back({&o});
    rows[at->second].time += o.time;
    ++rows[at->second].times;
  }
  std::string out = "  time     by operation:\n";
  for (std::size_t i = 0; i < std::min(most, rows.size()); ++i) {
    const Operation& o = *rows[i].first;
    out += "             " + clock(rows[i].time) + "  " +
           (o.tool > 0 ? "T" + std::to_string(o.tool) + "  " : std::string()) + "line " +
           std::to_string(o.line) + (o.name.empty() ? "" : "  " + printable(o.name)) +
           (rows[i].times > 1 ? " (" + std::to_string(rows[i].times) + " times)" : "") + "\n";
  }
  if (rows.size() > most)
    out += "             … and " + std::to_string(rows.size() - most) + " more, in result.json\n";
  return out;
}

// Messages of the same kind about the same bodies say the same again.
std::string alike_key(const Message& message) {
  std::string out = message.text.kind;
  if (const sim::Finding* f = message.finding)
    for (const std::string* part : {&f->body_a, &f->body_b, &f->joint})
      if (!part->empty()) out += (part == &f->body_b ? " and " : " of ") + *part;
  return out;
}

// At most `most`, and of those that are alike a tenth of that, so that many of one kind don't hide
// the others.
std::vector<const Message*> shortened(const std::vector<Message>& all, std::size_t most) {
  const std::size_t alike = std::max<std::size_t>(most / 10, 10);
  std::map<std::string, std::size_t> counts;
  std::vector<const Message*> out;
  for (const Message& message : all) {
    if (out.size() == most) break;
    if (all.size() <= alike || counts[alike_key(message)]++ < alike) out.push_back(&message);
  }
  return out;
}

// What `shown` leaves out, by what is alike; kinds in order of first appearance.
std::string left_out_text(const std::vector<Message>& all,
                          const std::vector<const Message*>& shown) {
  if (shown.size() == all.size()) return {};
  struct Alike {
    std::string key;
    std::size_t count = 0;
    SourceSpan first, last;
  };
  std::vector<Alike> left;
  std::map<std::string, std::size_t> place;
  auto next = shown.begin();
  for (const Message& message : all) {
    if (next != shown.end() && *next == &message) {
      ++next;
      continue;
    }
    const auto [at, fresh] = place.try_emplace(alike_key(message), left.size());
    if (fresh) left.push_back({at->first, 0, message.text.span, {}});
    ++left[at->second].count;
    left[at->second].last = message.text.span;
  }
  constexpr std::size_t most = 12;
  std::string out = "… and " + plural(all.size() - shown.size(), "more message") +
                    "; --format json has them all\n";
  for (std::size_t i = 0; i < std::min(most, left.size()); ++i) {
    const Alike& a = left[i];
    out += "  - " + std::to_string(a.count) + " " + printable(a.key);
    if (a.first && a.last) out += ", " + a.first.place() + " … " + std::to_string(a.last.line);
    out += "\n";
  }
  if (left.size() > most)
    out += "  - … of " + std::to_string(left.size() - most) + " other kinds\n";
  return out + "\n";
}

std::string summary_text(const RunReport& report, const std::vector<Message>& all,
                         const HumanOptions& options) {
  const sim::Summary& s = report.summary;
  std::size_t errors = 0, warnings = 0;
  for (const Message& message : all) {
    errors += message.text.severity == Severity::error ? 1 : 0;
    warnings += message.text.severity == Severity::warning ? 1 : 0;
  }

  std::string out = "verdict: ";
  if (options.style.color) out += verdict_paint(s.verdict);
  out += sim::to_string(s.verdict);
  if (options.style.color) out += "\x1b[0m";
  out += " (" + plural(errors, "error") + ", " + plural(warnings, "warning");
  if (!report.accepted.empty()) out += "; " + std::to_string(report.accepted.size()) + " accepted";
  out += ")\n";
  if (options.quiet) return out;

  if (report.units.size() > 1)
    out += programs_text(report);
  else
    out += "  program  " + printable(units_of(report).front().program) + ": ";
  out += plural(s.blocks, "block") + ", " + plural(s.moves, "move");
  if (report.machine.empty() || !report.units.empty()) return out + "\n";
  out += ", " + clock(s.cycle_time) + " (feed " + clock(s.feed_time) + ", rapid " +
         clock(s.rapid_time);
  if (s.tool_change_time > 0) out += ", tool change " + clock(s.tool_change_time);
  if (s.dwell_time > 0) out += ", dwell " + clock(s.dwell_time);
  if (s.spindle_wait_time > 0) out += ", spindle " + clock(s.spindle_wait_time);
  out += ")\n  machine  " + printable(report.machine);
  for (const auto& joint : s.joints) {
    const double scale = joint.rotary ? degrees : 1;
    out += (&joint == &s.joints.front() ? ": " : ", ") + printable(joint.name) + " " +
           fixed(joint.low * scale, 2) + " … " + fixed(joint.high * scale, 2) +
           (joint.rotary ? "°" : "");
  }
  out += "\n" + operations_text(report);
  if (s.collision.pairs > 0)
    out += "  checked  " + plural(s.collision.pairs, "pair") + " of " +
           std::to_string(s.collision.bodies) +
           " bodies over all of the motion: " + percent(s.collision.clear) + " proven clear, " +
           percent(s.collision.hit) + " in contact, " + percent(s.collision.unresolved) +
           " unresolved\n";
  if (s.stock)
    out += "  stock    " + fixed((s.stock->initial_volume - s.stock->volume) / 1000, 2) + " of " +
           fixed(s.stock->initial_volume / 1000, 2) + " cm³ cut away, on a lattice of " +
           shortest(s.stock->pitch) + " mm\n";
  if (s.part)
    out += "  part     " + plural(s.part->points, "place") + " compared: at most " +
           fixed(s.part->gouge, 3) + " mm into it (" + shortest(s.part->tol_gouge) +
           " allowed), at most " + fixed(s.part->excess, 3) + " mm left on it (" +
           shortest(s.part->tol_excess + s.part->allowance) + " allowed), between rays up to " +
           shortest(s.part->bound) + " mm more\n";
  if (report.accuracy) out += along_text(*report.accuracy);
  return out;
}

}  // namespace

Diagnostic to_diagnostic(const sim::Finding& f, const RunReport& report) {
  Diagnostic d;
  d.severity = f.severity;
  d.kind = std::string(sim::to_string(f.kind));
  d.message = f.message;
  d.span = f.span;
  d.remark = underline_remark(f);
  if (!f.expanded.empty()) d.notes.push_back({"step", f.expanded});
  if (f.depth && *f.depth > 0)
    d.notes.push_back({"depth", fixed(*f.depth, 2) + " mm (± " +
                                    fixed(f.depth_bound.value_or(0), 3) +
                                    ") deepest at t = " + seconds(f.t_worst)});
  if (f.depth && *f.depth <= 0)
    d.notes.push_back(
        {"distance",
         fixed(-*f.depth, 3) + " mm (± " + fixed(f.depth_bound.value_or(0), 3) + ")" +
             (f.limit ? "; near misses are told below " + shortest(*f.limit) + " mm" : "")});
  if (!f.points.empty())
    d.notes.push_back({"point", "X " + fixed(f.points[0].x(), 2) + "  Y " +
                                    fixed(f.points[0].y(), 2) + "  Z " + fixed(f.points[0].z(), 2) +
                                    " (bed axes, mm)"});
  if (f.joints_worst.size() > 0) d.notes.push_back({"joints", joints_text(f.joints_worst, report)});
  std::string state = f.work_system;
  if (f.tool > 0)
    state += ", T" + std::to_string(f.tool) +
             (f.tool_name.empty() ? "" : " \"" + f.tool_name + "\"") + " in the spindle";
  if (f.spindle_rpm != 0) state += ", spindle " + fixed(f.spindle_rpm, 0) + " rev/min";
  if (!state.empty()) d.notes.push_back({"state", state});
  if (!f.channel.empty()) d.notes.push_back({"channel", f.channel});
  if (!f.other_channel.empty())
    d.notes.push_back({"with", "channel " + f.other_channel +
                                   (f.other_span ? " at " + f.other_span.place() + ": " +
                                                       printable(f.other_span.line_text())
                                                 : "")});
  if (!f.picture.empty()) d.notes.push_back({"frame", f.picture});
  if (!f.remedy.empty()) d.notes.push_back({"help", f.remedy});
  return d;
}

std::string to_human(const RunReport& report, const HumanOptions& options) {
  std::string out;
  const std::vector<Message> all = messages(report, Take::episodes);
  if (!options.quiet) {
    const std::vector<std::string> open = unchecked(report);
    if (!open.empty()) out += "not checked:\n";
    for (std::size_t i = 0; i < std::min(open.size(), options.most); ++i)
      out += "  - " + printable(open[i]) + "\n";
    if (open.size() > options.most)
      out += "  - … and " + std::to_string(open.size() - options.most) + " more\n";
    if (!open.empty()) out += "\n";
    const std::vector<const Message*> shown = shortened(all, options.most);
    for (const Message* message : shown) {
      Diagnostic d = message->text;
      if (!d.span && !report.units.empty() && !message->program.empty())
        d.notes.insert(d.notes.begin(), {"program", message->program});
      out += format_human(d, options.style) + "\n";
    }
    out += left_out_text(all, shown);
    out += accepted_text(report, options.most);
  }
  return harmless(out + summary_text(report, all, options));
}

}  // namespace aircut::report
