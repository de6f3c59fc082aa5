// The rows of result.json: one function per item.

#include "report/json_items.h"

#include <cmath>

#include "report/accept.h"
#include "report/messages.h"

namespace aircut::report {

namespace {

constexpr int schema = 1;
constexpr double degrees = 180 / M_PI;

Json texts(const std::vector<std::string>& list) {
  Json out = Json::array();
  for (const std::string& text : list) out.push_back(utf8(text));
  return out;
}

Json place(const SourceSpan& span) {
  if (!span) return nullptr;
  Json calls = Json::array();
  for (const CallFrame* frame = span.calls.get(); frame; frame = frame->site.calls.get())
    calls.push_back({{"file", utf8(frame->site.text ? frame->site.text->name() : "")},
                     {"line", frame->site.line},
                     {"what", utf8(frame->text())}});
  return {{"file", utf8(span.text->name())},
          {"line", span.line},
          {"column", span.column()},
          {"block", utf8(span.line_text())},
          {"call_stack", calls}};
}

Json vector3(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json joints(const machine::JointVector& q, const RunReport& report) {
  Json out = Json::object();
  for (int j = 0; j < q.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (i >= report.joint_names.size()) break;
    out[utf8(report.joint_names[i]) + (report.joint_rotary[i] ? "_deg" : "_mm")] =
        report.joint_rotary[i] ? q[j] * degrees : q[j];
  }
  return out;
}

Json axes(const AxisValues& values) {
  Json out = Json::object();
  for (const Axis axis : all_axes) {
    const std::string key(1, static_cast<char>(letter(axis) + 32));
    out[key + (is_rotary(axis) ? "_deg" : "_mm")] =
        is_rotary(axis) ? values[axis] * degrees : values[axis];
  }
  return out;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json finding(const sim::Finding& f, const Diagnostic& text, const std::string& program,
             const RunReport& report) {
  Json points = Json::array();
  for (const Vec3& p : f.points) points.push_back(vector3(p));
  Json points_part = Json::array();
  for (const Vec3& p : f.points_part) points_part.push_back(vector3(p));
  Json out = {{"id", f.id},
              {"episode", f.episode},
              {"kind", sim::to_string(f.kind)},
              {"severity", to_string(f.severity)},
              {"message", utf8(f.message)},
              {"program", utf8(program)},
              {"place", place(f.span)},
              {"expanded", utf8(f.expanded)},
              {"tool", f.tool},
              {"tool_name", utf8(f.tool_name)},
              {"wcs", f.work_system},
              {"motion", plan::to_string(f.motion)},
              {"t_first_s", f.t_first},
              {"t_worst_s", f.t_worst},
              {"t_end_s", f.t_end},
              {"u_first", f.u_first},
              {"u_end", f.u_end},
              {"joints_first", joints(f.joints_first, report)},
              {"joints_worst", joints(f.joints_worst, report)},
              {"h_offset", f.length_offset > 0 ? Json(f.length_offset) : Json(nullptr)},
              {"tcp_machine", axes(f.tip)},
              {"tcp_part_mm", f.tip_part ? vector3(*f.tip_part) : Json(nullptr)},
              {"tool_axis", vector3(f.tool_axis)},
              {"feed_mm_per_min", f.feed * 60},
              {"feed_actual_mm_per_min", f.feed_actual * 60},
              {"spindle_rpm", f.spindle_rpm},
              {"body_a", utf8(f.body_a)},
              {"body_b", utf8(f.body_b)},
              {"pair", f.pair},
              {"depth_mm", or_null(f.depth)},
              {"depth_bound_mm", or_null(f.depth_bound)},
              {"points_mm", points},
              {"points_part_mm", points_part},
              {"axial_retract_mm", or_null(f.axial_retract)},
              {"retreat_mm", or_null(f.retreat)},
              {"volume_mm3", f.unit == "mm3" ? or_null(f.value) : Json(nullptr)},
              {"normal", vector3(f.normal)},
              {"joint", utf8(f.joint)},
              {"quantity", f.quantity},
              {"value", or_null(f.value)},
              {"limit", or_null(f.limit)},
              {"unit", f.unit},
              {"unresolved", f.unresolved},
              {"makes_unknown", f.makes_unknown},
              {"remedy", utf8(f.remedy)},
              {"picture", utf8(f.picture)},
              {"fingerprint", fingerprint_of(text, program, &f, report.folder)}};
  if (!f.channel.empty()) out["channel"] = utf8(f.channel);
  if (!f.other_channel.empty()) {
    out["other_channel"] = utf8(f.other_channel);
    out["other_place"] = place(f.other_span);
  }
  return out;
}

Json diagnostic(const Diagnostic& d, const std::string& program, const std::string& fingerprint) {
  Json notes = Json::array();
  for (const Note& note : d.notes)
    notes.push_back({{"label", utf8(note.label)}, {"text", utf8(note.text)}});
  return {{"kind", d.kind},
          {"severity", to_string(d.severity)},
          {"message", utf8(d.message)},
          {"program", utf8(program)},
          {"place", place(d.span)},
          {"notes", notes},
          {"fingerprint", fingerprint}};
}

Json programs(const RunReport& report) {
  Json out = Json::array();
  for (const Unit& unit : units_of(report))
    out.push_back({{"program", utf8(unit.program)},
                   {"verdict", sim::to_string(unit.verdict)},
                   {"blocks", unit.blocks},
                   {"moves", unit.moves},
                   {"unchecked", texts(unit.unchecked)}});
  return out;
}

Json stock(const std::optional<sim::Summary::Stock>& stock) {
  if (!stock) return nullptr;
  return {{"pitch_mm", stock->pitch},
          {"sweep_bound_mm", stock->sweep_bound},
          {"initial_mm3", stock->initial_volume},
          {"final_mm3", stock->volume},
          {"removed_mm3", stock->initial_volume - stock->volume}};
}

Json part(const std::optional<sim::Summary::Part>& part) {
  if (!part) return nullptr;
  return {{"largest_gouge_mm", part->gouge},
          {"largest_excess_mm", part->excess},
          {"bound_mm", part->bound},
          {"tolerance_gouge_mm", part->tol_gouge},
          {"tolerance_excess_mm", part->tol_excess},
          {"allowance_mm", part->allowance},
          {"gouges", part->gouges},
          {"excesses", part->excesses},
          {"points", part->points}};
}

Json collision(const sim::Summary::Collision& c) {
  return {{"bodies", c.bodies},
          {"pairs", c.pairs},
          {"share_clear", c.clear},
          {"share_hit", c.hit},
          {"share_unresolved", c.unresolved},
          {"distance_queries", c.distance_queries},
          {"overlap_queries", c.overlap_queries},
          {"exclusions", texts(c.exclusions)}};
}

}  // namespace

Json head_items(const RunReport& report) {
  Json inputs = Json::array();
  for (const Input& input : report.inputs)
    inputs.push_back({{"role", input.role}, {"path", utf8(input.path)}, {"sha256", input.sha256}});
  return {{"inputs", inputs},
          {"machine", utf8(report.machine)},
          {"checks", report.checks},
          {"settings", report.settings}};
}

Json first_items(const RunReport& report) {
  return {{"schema", schema}, {"aircut", report.version}};
}

Json verdict_items(const RunReport& report) {
  return {{"verdict", sim::to_string(report.summary.verdict)},
          {"cause", cause_of(report)},
          {"interrupted", report.summary.interrupted}};
}

Json unchecked_items(const RunReport& report) { return texts(unchecked(report)); }

void each_finding(const RunReport& report, const std::function<void(Json)>& tell) {
  for (const Message& message : messages(report, Take::rows))
    tell(message.finding
             ? finding(*message.finding, message.text, message.program, report)
             : diagnostic(message.text, message.program,
                          fingerprint_of(message.text, message.program, nullptr, report.folder)));
}

Json accepted_items(const RunReport& report) {
  Json out = Json::array();
  for (const Accepted& a : report.accepted) {
    Json row = diagnostic(a.message, a.program, a.fingerprint);
    row["reason"] = utf8(a.reason);
    row["by"] = a.baseline ? "baseline" : "waiver";
    out.push_back(std::move(row));
  }
  return out;
}

Json summary_item(const RunReport& report) {
  const sim::Summary& s = report.summary;
  std::map<Severity, int> counts;
  for (const Diagnostic& d : report.diagnostics) ++counts[d.severity];
  for (const sim::Finding& f : report.findings) ++counts[f.severity];
  return {{"errors", counts[Severity::error]},
          {"warnings", counts[Severity::warning]},
          {"infos", counts[Severity::info]},
          {"accepted", report.accepted.size()},
          {"findings_dropped", s.findings_dropped},
          {"program_refused", s.program_refused},
          {"blocks", s.blocks},
          {"moves", s.moves}};
}

Json peaks(const std::vector<JointPeak>& list) {
  Json out = Json::object();
  for (const JointPeak& peak : list) {
    const auto at = [&](const JointPeak::At& a, const char* per) {
      return Json{{"value", a.value}, {"unit", peak.unit + per}, {"t_s", a.t}, {"line", a.line}};
    };
    out[utf8(peak.joint)] = {{"speed", at(peak.speed, "/s")},
                             {"acceleration", at(peak.acceleration, "/s^2")},
                             {"jerk", at(peak.jerk, "/s^3")}};
  }
  return out;
}

Json tail_items(const RunReport& report) {
  const sim::Summary& s = report.summary;
  Json extents = Json::object();
  for (const auto& joint : s.joints) {
    const double scale = joint.rotary ? degrees : 1;
    extents[utf8(joint.name)] = {{"low", joint.low * scale},
                                 {"high", joint.high * scale},
                                 {"unit", joint.rotary ? "deg" : "mm"}};
  }
  Json waivers = Json::array();
  for (const Waiver& w : report.waivers)
    waivers.push_back({{"waiver", utf8(w.text)}, {"reason", utf8(w.reason)}, {"used", w.used}});
  Json timing = {{"cycle_time_s", s.cycle_time},
                 {"feed_s", s.feed_time},
                 {"rapid_s", s.rapid_time},
                 {"dwell_s", s.dwell_time},
                 {"tool_change_s", s.tool_change_time}};
  if (s.spindle_wait_time > 0) timing["spindle_wait_s"] = s.spindle_wait_time;
  if (s.blend_time > 0) timing["blend_s"] = s.blend_time;
  if (!report.held_by.empty()) {
    Json held = Json::object();
    for (const auto& [cause, seconds] : report.held_by) held[utf8(cause)] = seconds;
    timing["held_by_s"] = held;
  }
  Json operations = Json::array();
  for (const Operation& o : report.operations)
    operations.push_back({{"name", utf8(o.name)},
                          {"line", o.line},
                          {"tool", o.tool},
                          {"time_s", o.time},
                          {"feed_s", o.feed},
                          {"rapid_s", o.rapid},
                          {"tool_change_s", o.tool_change}});
  if (!report.operations.empty()) timing["operations"] = operations;
  Json out = {{"waivers", waivers},
              {"baseline_gone", or_null(report.baseline_gone)},
              {"programs", programs(report)},
              {"timing", timing},
              {"extents", extents}};
  if (!report.channels.empty()) {
    Json rows = Json::array();
    for (const ChannelRow& row : report.channels)
      rows.push_back({{"channel", utf8(row.name)},
                      {"program", utf8(row.program)},
                      {"cycle_time_s", row.time},
                      {"waiting_s", row.waiting},
                      {"blocks", row.blocks},
                      {"moves", row.moves}});
    out["channels"] = rows;
  }
  if (!report.peaks.empty()) out["peaks"] = peaks(report.peaks);
  if (report.accuracy) out["accuracy"] = along_item(*report.accuracy);
  if (report.planner.pieces > 0)
    out["planner"] = {{"pieces", report.planner.pieces},
                      {"nodes", report.planner.nodes},
                      {"jerk_windows", report.planner.jerk_windows},
                      {"newton_steps", report.planner.newton_steps}};
  if (const auto& chord = report.chord_error)
    out["chord_error"] = {
        {"value", chord->value}, {"unit", "mm"}, {"t_s", chord->t}, {"line", chord->line}};
  out.update({{"collision", collision(s.collision)},
              {"stock", stock(s.stock)},
              {"part", part(s.part)},
              {"outputs", texts(report.outputs)}});
  return out;
}

std::string json_text(const Json& json, int indent) {
  const std::string text = json.dump(indent, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    // `<` stands in strings only.
    if (text[i] == '<')
      out += "\\u003c";
    else if (text[i] == '\x7f')
      out += "\\u007f";
    else
      out += text[i];
  }
  return out + "\n";
}

}  // namespace aircut::report
