// Findings of every kind and reports built by hand.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace aircut::report::testing {

inline const char* const program_text =
    "G21 G90 G54\n"
    "T4 M6\n"
    "G1 X40.0 F600\n"
    "G0 X12.0 Z-4.0\n"
    "G0 X14.0\n"
    "M110\n"
    "M2\n";

/// A program's text and reports about it. Every sample is complete, so that a field that a format
/// forgets is missed by a golden file.
class Samples {
 public:
  Samples() : program_(sources_.add("parts/side.ngc", program_text)) {}

  SourceMap& sources() { return sources_; }
  SourceSpan line(std::uint32_t number) const { return line_of(program_, number); }

  static SourceSpan line_of(const SourceText& text, std::uint32_t number) {
    const std::string_view all = text.content();
    std::size_t begin = 0;
    for (std::uint32_t i = 1; i < number; ++i) begin = all.find('\n', begin) + 1;
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    return {.text = &text,
            .begin = begin,
            .length = static_cast<std::uint32_t>(end - begin),
            .line = number};
  }

  /// A report of a run without any finding.
  RunReport clean() const {
    RunReport r;
    r.version = "0.1.0";
    r.machine = "boxes";
    r.inputs = {{"program", "parts/side.ngc", std::string(64, 'a')},
                {"machine", "mill3", std::string(64, 'b')}};
    r.checks = {"syntax", "limits", "collision"};
    r.settings = {{"near_mm", 2}, {"period_s", 0.001}};
    r.joint_names = {"X", "Y", "Z", "C"};
    r.joint_rotary = {false, false, false, true};
    sim::Summary& s = r.summary;
    s.verdict = sim::Verdict::pass;
    s.cycle_time = 3723.4;
    s.feed_time = 3600;
    s.rapid_time = 100;
    s.dwell_time = 3.4;
    s.tool_change_time = 20;
    s.blocks = 7;
    s.moves = 3;
    s.joints = {{"X", false, -10.5, 412}, {"C", true, 0, M_PI}};
    s.collision = {.bodies = 9,
                   .pairs = 14,
                   .distance_queries = 100,
                   .overlap_queries = 3,
                   .clear = 1,
                   .exclusions = {"way-cover – bed: slides on it"}};
    r.outputs = {"joints.csv"};
    return r;
  }

  sim::Finding finding(sim::Kind kind, std::uint32_t at_line, const std::string& message) const {
    sim::Finding f;
    f.id = f.episode = ++count_;
    f.kind = kind;
    f.severity = sim::severity_of(kind);
    f.message = message;
    f.span = line(at_line);
    f.block = at_line;
    f.tool = 4;
    f.tool_name = "10 mm 3-flute";
    f.work_system = "G54";
    f.motion = plan::MotionKind::rapid;
    f.t_first = 84.213;
    f.t_worst = 84.371;
    f.t_end = 84.42;
    f.u_first = 0.61;
    f.u_end = 0.88;
    f.joints_first = f.joints_worst = machine::JointVector(4);
    f.joints_first << 410, 180, -95, 0;
    f.joints_worst << 412, 180.25, -96.114, M_PI / 2;
    f.tip[Axis::x] = 12;
    f.feed = 200;
    f.feed_actual = 150;
    f.spindle_rpm = 8000;
    return f;
  }

  sim::Finding collision() const {
    sim::Finding f =
        finding(sim::Kind::collision, 4,
                "tool holder `T4/holder` hits fixture `vise/fixed-jaw` during a rapid");
    f.body_a = "T4/holder";
    f.body_b = "vise/fixed-jaw";
    f.pair = "holder-fixture";
    f.depth = 3.21;
    f.depth_bound = 0.01;
    f.points = {Vec3(12, 30, -4)};
    f.normal = Vec3(0, 0, 1);
    f.remedy = "retract Z by 3.22 mm first";
    f.picture = "frames/collision-L4.png";
    return f;
  }
  sim::Finding near_miss() const {
    sim::Finding f = finding(sim::Kind::near_miss, 3, "cutter passes `clamp` at 0.4 mm");
    f.body_a = "T4/cutter";
    f.body_b = "clamp";
    f.pair = "cutter-fixture";
    f.depth = -0.4;
    f.depth_bound = 0.005;
    f.value = 0.4;
    f.limit = 2;
    f.unit = "mm";
    f.t_first = f.t_end = f.t_worst;
    return f;
  }
  sim::Finding unresolved() const {
    sim::Finding f = near_miss();
    f.message = "neither contact nor clearance of cutter and `clamp` can be proven";
    f.unresolved = true;
    return f;
  }
  sim::Finding overtravel() const {
    sim::Finding f = finding(sim::Kind::overtravel, 5,
                             "X passes its upper limit by 14.000 mm: it reaches 214.000 mm, the "
                             "limit is 200.000 mm");
    f.joint = "X";
    f.value = 214;
    f.limit = 200;
    f.unit = "mm";
    f.remedy = "shift the work by -14 mm";
    return f;
  }
  sim::Finding not_executed() const {
    sim::Finding f = finding(sim::Kind::not_executed, 6, "M110 was not run");
    f.makes_unknown = true;
    return f;
  }

  /// One finding of each kind, near misses also unresolved.
  std::vector<sim::Finding> every_kind() const {
    using sim::Kind;
    std::vector<sim::Finding> out = {collision(), near_miss(), unresolved(), overtravel(),
                                     not_executed()};
    out.push_back(finding(Kind::self_overlap, 1, "`way-cover` and `bed` overlap at the start"));
    out.back().span = {};
    out.push_back(finding(Kind::tool_change_collision, 2, "T4/cutter is inside `vise`"));
    out.push_back(finding(Kind::unreachable, 5, "no joints for this point: rod 1 is too short"));
    out.push_back(finding(Kind::singular, 5, "joint C would need an unlimited speed"));
    out.push_back(finding(Kind::sync_limit, 5, "the way is too short to catch up"));
    out.push_back(finding(Kind::rapid_cut, 3, "the cutter goes through stock during a rapid"));
    out.back().body_a = "T4/cutter";
    out.back().body_b = "stock";
    out.push_back(finding(Kind::spindle_stopped_cut, 4, "the spindle stands"));
    out.push_back(finding(Kind::spindle_direction_cut, 4, "the spindle turns backwards"));
    out.push_back(finding(Kind::no_tool_cut, 1, "there is no tool in the spindle"));
    out.push_back(finding(Kind::plunge_not_center_cutting, 5, "it can't cut at its centre"));
    out.push_back(finding(Kind::overtravel_margin, 5, "`X` comes to 0.250 mm of its limit 200"));
    out.push_back(finding(Kind::axis_unwind, 5, "`C` turns by 200° and the tool points as before"));
    out.push_back(finding(Kind::feed_not_reached, 4, "the feed stays under half of F6000"));
    out.push_back(finding(Kind::engagement_limit, 4, "axial depth of 5 mm, the limit is 4 mm"));
    out.back().quantity = "axial depth";
    out.push_back(finding(Kind::loose_piece, 4, "a piece of the stock comes loose"));
    out.push_back(finding(Kind::air_cut, 6, "this feed move takes no material"));
    out.push_back(finding(Kind::gouge_live, 5, "cutter `T4/cutter` goes into the part"));
    out.push_back(finding(Kind::gouge, 5, "the result is cut 0.200 mm into the part"));
    out.push_back(finding(Kind::excess, 6, "0.300 mm of material is left on the part"));
    out.push_back(finding(Kind::wrong_setup, 1, "the part stands out of the raw piece"));
    out.push_back(finding(Kind::dynamics_limit, 5, "the jerk limit of joint X is passed"));
    out.push_back(finding(Kind::branch_flip, 5, "`C` jumps by 180.000°"));
    out.push_back(finding(Kind::velocity_limit, 5, "the speed of `X` comes to 101.000 mm/s"));
    out.push_back(finding(Kind::acceleration_limit, 5, "the acceleration of `X` is too large"));
    out.push_back(finding(Kind::jerk_limit, 5, "the jerk of `X` is too large"));
    out.push_back(finding(Kind::path_deviation, 5, "the planned path is 0.0200 mm off"));
    out.push_back(finding(Kind::tool_missing, 2, "T4 is not in the tool table"));
    out.push_back(finding(Kind::not_checked, 2, "T4 has no geometry"));
    out.back().makes_unknown = true;
    out.push_back(finding(Kind::probe_contact, 3, "probe `T4/probe` touches `vise`"));
    out.push_back(finding(Kind::spindle_conflict, 2, "two channels command one spindle"));
    out.push_back(finding(Kind::axis_conflict, 2, "two channels move the axis C"));
    out.push_back(finding(Kind::wait_deadlock, 2, "channel upper waits for ever"));
    out.push_back(finding(Kind::probe_missed, 4, "the probing move ends without a touch"));
    return out;
  }

  RunReport full() const {
    RunReport r = clean();
    r.findings = every_kind();
    r.diagnostics.push_back(make_error("arc_error", word(3, 3, 5), "the end is off the circle"));
    r.diagnostics.back().notes.push_back({"help", "write I5"});
    r.diagnostics.push_back({Severity::warning, "word_ignored", "Q is ignored here", line(7)});
    r.summary.verdict = sim::Verdict::fail;
    r.summary.unchecked = {"everything after parts/side.ngc:7"};
    r.summary.collision.clear = 0.99991;
    r.summary.collision.hit = 0.00005;
    r.summary.collision.unresolved = 0.00004;
    return r;
  }

  SourceSpan word(std::uint32_t number, std::uint64_t offset, std::uint32_t length) const {
    SourceSpan span = line(number);
    span.begin += offset;
    span.length = length;
    return span;
  }

 private:
  mutable int count_ = 0;
  SourceMap sources_;
  const SourceText& program_;
};

/// What a file could hold to break a format or to drive a terminal: escape sequences, also as C1
/// control, quotes, markup, line ends that begin something, invalid UTF-8, direction overrides.
inline const std::string hostile =
    "\x1b[31mred \"quoted\" 'q' \\ </script><!-- ]]> &amp; <b>\r\n::error::mine\n##[error]x "
    "%0A \xff\xfe \xc2\x9b"
    "31m \xe2\x80\xae txt \xed\xa0\x80 \x7f \x01 {fmt} %s,:";

/// A report in which every text of an input is hostile.
class HostileSamples {
 public:
  HostileSamples()
      : program_(sources_.add("a" + hostile + ".ngc", "G1 " + hostile + "\n" + hostile)) {}
  RunReport report() const {
    Samples plain;
    RunReport r = plain.clean();
    r.machine = hostile;
    r.inputs[0].path = program_.name();
    r.joint_names[0] = hostile;
    r.summary.joints[0].name = hostile;
    r.summary.unchecked = {hostile};
    r.summary.collision.exclusions = {hostile};
    r.summary.verdict = sim::Verdict::fail;
    sim::Finding f = plain.collision();
    f.span = Samples::line_of(program_, 1);
    f.span.calls = std::make_shared<const CallFrame>(
        CallFrame{Samples::line_of(program_, 2), "o<" + hostile + "> call"});
    f.message = f.tool_name = f.body_a = f.body_b = f.joint = f.remedy = f.picture = f.expanded =
        hostile;
    f.unresolved = true;
    r.findings = {f};
    r.diagnostics.push_back(make_error("arc_error", f.span, hostile));
    r.diagnostics.back().notes.push_back({"help", hostile});
    return r;
  }

 private:
  SourceMap sources_;
  const SourceText& program_;
};

/// Three programs of one check: a clean one, a refused one, one that can't be read.
inline RunReport three_programs(const Samples& samples) {
  RunReport r = samples.clean();
  r.machine.clear();
  r.checks = {"syntax"};
  r.inputs = {{"program", "good.ngc", std::string(64, 'c')},
              {"program", "parts/side.ngc", std::string(64, 'a')}};
  r.diagnostics = {{Severity::warning, "tools_invalid", "the table has two tools 4"},
                   make_error("arc_error", samples.line(3), "the end is off the circle"),
                   {Severity::warning, "word_ignored", "Q is ignored here", samples.line(7)}};
  r.units = {{"good.ngc", sim::Verdict::pass, 5, 2, {}, 1, 0},
             {"parts/side.ngc", sim::Verdict::fail, 7, 3, {}, 1, 2},
             {"gone.ngc", sim::Verdict::unknown, 0, 0, {"can't read 'gone.ngc'"}, 3, 0}};
  r.summary = {};
  r.summary.verdict = sim::Verdict::fail;
  r.summary.blocks = 12;
  r.summary.moves = 5;
  r.summary.unchecked = {"can't read 'gone.ngc'"};
  return r;
}

}  // namespace aircut::report::testing
