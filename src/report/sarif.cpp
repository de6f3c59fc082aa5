// SARIF 2.1.0: one run; a rule is a kind of message with its long text, a result is a message.
//
// Code hosts tell an old result from a new one by its fingerprint (fingerprint.cpp) and, since
// programs repeat themselves, by how many of the same came before.

#include <algorithm>
#include <map>

#include "report/accept.h"
#include "report/json_items.h"
#include "report/messages.h"
#include "report/paths.h"

namespace aircut::report {

namespace {

class Writer {
 public:
  Writer(const RunReport& report, const SarifOptions& options)
      : report_(report), options_(options), all_(messages(report, Take::rows)) {
    for (const Message& message : all_) rules_.emplace(message.text.kind, 0);
    for (const Accepted& a : report_.accepted) rules_.emplace(a.message.kind, 0);
    std::size_t index = 0;
    for (auto& [kind, place] : rules_) place = index++;
  }

  Json document() {
    Json results = Json::array();
    for (std::size_t i = 0; i < std::min(all_.size(), options_.most); ++i)
      results.push_back(result(all_[i], hash_of(all_[i])));
    for (std::size_t i = 0; i < report_.accepted.size() && results.size() < options_.most; ++i) {
      const Accepted& a = report_.accepted[i];
      Json row = result({a.message, a.program, nullptr, false}, a.fingerprint);
      row["suppressions"] =
          Json::array({{{"kind", "external"}, {"justification", printable(a.reason)}}});
      results.push_back(std::move(row));
    }
    Json run = {
        {"tool",
         {{"driver", {{"name", "aircut"}, {"version", report_.version}, {"rules", rules()}}}}},
        {"columnKind", "unicodeCodePoints"},
        {"invocations", Json::array({invocation()})},
        {"artifacts", artifacts()},
        {"results", std::move(results)},
        {"properties", {{"verdict", sim::to_string(report_.summary.verdict)}}}};
    return {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
            {"version", "2.1.0"},
            {"runs", Json::array({std::move(run)})}};
  }

 private:
  static const char* level(Severity severity) {
    switch (severity) {
      case Severity::error:
        return "error";
      case Severity::warning:
        return "warning";
      case Severity::info:
        return "note";
    }
    return "error";
  }

  Json rules() const {
    Json out = Json::array();
    for (const auto& [kind, index] : rules_) {
      Json rule = {{"id", kind}};
      for (const KindText& row : options_.kinds)
        if (kind == row.kind) {
          rule["shortDescription"] = {{"text", row.title}};
          rule["fullDescription"] = {{"text", row.text}};
          rule["help"] = {{"text", row.text}};
          break;
        }
      out.push_back(std::move(rule));
    }
    return out;
  }

  Json artifact(const std::string& path) const { return {{"uri", uri_of(path, options_.folder)}}; }

  Json location(const SourceSpan& span) const {
    const std::size_t column = span.column();
    const std::size_t width = std::max<std::size_t>(1, count_characters(utf8(span.covered())));
    return {{"physicalLocation",
             {{"artifactLocation", artifact(span.text->name())},
              {"region",
               {{"startLine", span.line},
                {"startColumn", column},
                {"endColumn", column + width},
                {"snippet", {{"text", utf8(span.covered())}}}}}}}};
  }

  Json locations(const Message& message) const {
    if (message.text.span) return Json::array({location(message.text.span)});
    if (message.program.empty()) return Json::array();
    return Json::array({{{"physicalLocation", {{"artifactLocation", artifact(message.program)}}}}});
  }

  // Where the block was called from, innermost first.
  Json callers(const SourceSpan& span) const {
    Json out = Json::array();
    for (const CallFrame* frame = span.calls.get(); frame; frame = frame->site.calls.get()) {
      if (!frame->site) continue;
      Json place = location(frame->site);
      place["message"] = {{"text", printable(frame->text())}};
      out.push_back(std::move(place));
    }
    return out;
  }

  std::string hash_of(const Message& message) const {
    return fingerprint_of(message.text, message.program, message.finding, options_.folder);
  }

  Json result(const Message& message, const std::string& hash) {
    const Diagnostic& d = message.text;
    std::string text = printable(d.message);
    for (const Note& note : d.notes)
      if (note.label == "help") text += ". Help: " + printable(note.text);
    Json out = {
        {"ruleId", d.kind},
        {"ruleIndex", rules_.at(d.kind)},
        {"level", level(d.severity)},
        {"message", {{"text", text}}},
        {"locations", locations(message)},
        {"partialFingerprints", {{"aircutBlock/v1", hash + ":" + std::to_string(++seen_[hash])}}}};
    if (d.span && d.span.calls) out["relatedLocations"] = callers(d.span);
    if (const sim::Finding* f = message.finding)
      out["properties"] = {{"episode", f->episode},
                           {"t_first_s", f->t_first},
                           {"t_end_s", f->t_end},
                           {"unresolved", f->unresolved}};
    return out;
  }

  static Json notification(const char* id, const char* severity, const std::string& text) {
    return {{"descriptor", {{"id", id}}}, {"level", severity}, {"message", {{"text", text}}}};
  }

  // What was not checked, and how much was left out, are notifications of the tool.
  Json invocation() const {
    const std::vector<std::string> open = unchecked(report_);
    Json notes = Json::array();
    for (std::size_t i = 0; i < std::min(open.size(), options_.most); ++i)
      notes.push_back(notification("not_checked", "error", "not checked: " + printable(open[i])));
    if (open.size() > options_.most)
      notes.push_back(
          notification("not_checked", "error",
                       "not checked: " + std::to_string(open.size() - options_.most) + " more"));
    if (all_.size() > options_.most)
      notes.push_back(notification("limit_reached", "warning",
                                   std::to_string(all_.size() - options_.most) + " of " +
                                       std::to_string(all_.size()) +
                                       " results are not listed; --format json has them all"));
    return {{"executionSuccessful", !report_.summary.interrupted && open.empty()},
            {"toolExecutionNotifications", std::move(notes)}};
  }

  Json artifacts() const {
    Json out = Json::array();
    for (const Input& input : report_.inputs)
      if (input.role == "program")
        out.push_back({{"location", artifact(input.path)},
                       {"hashes", {{"sha-256", input.sha256}}},
                       {"roles", Json::array({"analysisTarget"})}});
    return out;
  }

  const RunReport& report_;
  const SarifOptions& options_;
  std::vector<Message> all_;
  std::map<std::string, std::size_t> rules_;  ///< kind → index
  std::map<std::string, int> seen_;           ///< fingerprints so far
};

}  // namespace

std::string to_sarif(const RunReport& report, const SarifOptions& options) {
  return json_text(Writer(report, options).document(), 2);
}

}  // namespace aircut::report
