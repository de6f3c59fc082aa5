// result.json, schema 1. Lengths mm, angles degrees, time s, feeds mm/min; keys carry the unit.

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/report.h"

namespace aircut::report {

namespace {

using Json = nlohmann::ordered_json;

constexpr int schema = 1;
constexpr double degrees = 180 / M_PI;

// Text of an input may be in any encoding; JSON must be UTF-8.
std::string utf8(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t width = byte < 0x80    ? 1
                              : byte >= 0xf0 ? 4
                              : byte >= 0xe0 ? 3
                              : byte >= 0xc2 ? 2
                                             : 0;
    bool valid = width > 0 && i + width <= text.size();
    for (std::size_t k = 1; valid && k < width; ++k)
      valid = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
    if (valid) {
      out += text.substr(i, width);
      i += width;
    } else {  // Latin-1, as old programs are written
      if (byte < 0xc0) {
        out += '\xc2';
        out += static_cast<char>(byte);
      } else {
        out += '\xc3';
        out += static_cast<char>(byte - 0x40);
      }
      ++i;
    }
  }
  return out;
}

Json place(const SourceSpan& span) {
  if (!span) return nullptr;
  Json calls = Json::array();
  for (const CallFrame* frame = span.calls.get(); frame; frame = frame->site.calls.get())
    calls.push_back({{"file", utf8(frame->site.text ? frame->site.text->name() : "")},
                     {"line", frame->site.line},
                     {"what", utf8(frame->what)}});
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
    out[report.joint_names[i] + (report.joint_rotary[i] ? "_deg" : "_mm")] =
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

Json finding(const sim::Finding& f, const RunReport& report) {
  Json points = Json::array();
  for (const Vec3& p : f.points) points.push_back(vector3(p));
  return {{"id", f.id},
          {"episode", f.episode},
          {"kind", sim::to_string(f.kind)},
          {"severity", to_string(f.severity)},
          {"message", utf8(f.message)},
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
          {"tcp_machine", axes(f.tip)},
          {"feed_mm_per_min", f.feed * 60},
          {"feed_actual_mm_per_min", f.feed_actual * 60},
          {"spindle_rpm", f.spindle_rpm},
          {"body_a", utf8(f.body_a)},
          {"body_b", utf8(f.body_b)},
          {"pair", f.pair},
          {"depth_mm", or_null(f.depth)},
          {"depth_bound_mm", or_null(f.depth_bound)},
          {"points_mm", points},
          {"normal", vector3(f.normal)},
          {"joint", utf8(f.joint)},
          {"value", or_null(f.value)},
          {"limit", or_null(f.limit)},
          {"unit", f.unit},
          {"unresolved", f.unresolved},
          {"makes_unknown", f.makes_unknown},
          {"remedy", utf8(f.remedy)},
          {"picture", utf8(f.picture)}};
}

Json diagnostic(const Diagnostic& d) {
  Json notes = Json::array();
  for (const Note& note : d.notes)
    notes.push_back({{"label", note.label}, {"text", utf8(note.text)}});
  return {{"kind", d.kind},
          {"severity", to_string(d.severity)},
          {"message", utf8(d.message)},
          {"place", place(d.span)},
          {"notes", notes}};
}

}  // namespace

std::string to_json(const RunReport& report) {
  const sim::Summary& s = report.summary;
  Json inputs = Json::array();
  for (const Input& input : report.inputs)
    inputs.push_back({{"role", input.role}, {"path", utf8(input.path)}, {"sha256", input.sha256}});

  Json findings = Json::array();
  std::map<std::string, int> counts{{"error", 0}, {"warning", 0}, {"info", 0}};
  for (const Diagnostic& d : report.diagnostics) {
    findings.push_back(diagnostic(d));
    ++counts[std::string(to_string(d.severity))];
  }
  for (const sim::Finding& f : report.findings) {
    findings.push_back(finding(f, report));
    ++counts[std::string(to_string(f.severity))];
  }
  Json extents = Json::object();
  for (const auto& joint : s.joints) {
    const double scale = joint.rotary ? degrees : 1;
    extents[joint.name] = {{"low", joint.low * scale},
                           {"high", joint.high * scale},
                           {"unit", joint.rotary ? "deg" : "mm"}};
  }
  Json unchecked = Json::array();
  for (const std::string& what : s.unchecked) unchecked.push_back(utf8(what));
  Json exclusions = Json::array();
  for (const std::string& what : s.collision.exclusions) exclusions.push_back(utf8(what));

  const Json out = {
      {"schema", schema},
      {"aircut", report.version},
      {"verdict", sim::to_string(s.verdict)},
      {"interrupted", s.interrupted},
      {"inputs", inputs},
      {"machine", utf8(report.machine)},
      {"checks", report.checks},
      {"settings", report.settings},
      {"summary",
       {{"errors", counts["error"]},
        {"warnings", counts["warning"]},
        {"infos", counts["info"]},
        {"findings_dropped", s.findings_dropped},
        {"program_refused", s.program_refused},
        {"blocks", s.blocks},
        {"moves", s.moves}}},
      {"unchecked", unchecked},
      {"findings", findings},
      {"timing",
       {{"cycle_time_s", s.cycle_time},
        {"feed_s", s.feed_time},
        {"rapid_s", s.rapid_time},
        {"dwell_s", s.dwell_time},
        {"tool_change_s", s.tool_change_time}}},
      {"extents", extents},
      {"collision",
       {{"bodies", s.collision.bodies},
        {"pairs", s.collision.pairs},
        {"share_clear", s.collision.clear},
        {"share_hit", s.collision.hit},
        {"share_unresolved", s.collision.unresolved},
        {"distance_queries", s.collision.distance_queries},
        {"overlap_queries", s.collision.overlap_queries},
        {"exclusions", exclusions}}},
      {"outputs", report.outputs},
  };
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace aircut::report
