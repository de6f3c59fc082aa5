#include "report/accept.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace aircut::report {

namespace {

using Json = nlohmann::json;

bool matches(const Waiver& waiver, const Diagnostic& message, const std::string& program) {
  if (waiver.kind != message.kind) return false;
  if (waiver.line != 0 && message.span.line != waiver.line) return false;
  if (waiver.file.empty()) return true;
  const std::string& name = message.span ? message.span.text->name() : program;
  return name == waiver.file || name.ends_with("/" + waiver.file);
}

std::string told_as(const Diagnostic& message) {
  return (message.span ? message.span.place() + ": " : std::string()) + message.message;
}

bool makes_unknown(const std::string& kind) {
  static const char* const kinds[] = {"not_checked", "not_executed", "limit_reached", "loop_limit"};
  return std::find(std::begin(kinds), std::end(kinds), kind) != std::end(kinds);
}

// All fingerprints of the rows in a list of result.json.
void count_rows(const Json& rows, Baseline& out) {
  if (!rows.is_array()) return;
  for (const Json& row : rows)
    if (row.is_object() && row.contains("fingerprint") && row["fingerprint"].is_string())
      ++out[row["fingerprint"].get<std::string>()];
}

void count_sarif(const Json& runs, Baseline& out) {
  for (const Json& run : runs)
    for (const Json& result : run.value("results", Json::array())) {
      const std::string print = result.value("partialFingerprints", Json::object())
                                    .value("aircutBlock/v1", std::string());
      if (!print.empty()) ++out[print.substr(0, print.find(':'))];
    }
}

}  // namespace

Expected<Waiver> read_waiver(const std::string& text) {
  Waiver waiver;
  waiver.text = text;
  const std::size_t equals = text.find('=');
  const auto fail = [&](const std::string& why) {
    return unexpected(make_error("usage", "--waive '" + printable(text) + "': " + why +
                                              "; write KIND=REASON, KIND:FILE=REASON or "
                                              "KIND:FILE:LINE=REASON"));
  };
  if (equals == std::string::npos) return fail("there is no '='");
  waiver.reason = text.substr(equals + 1);
  if (waiver.reason.find_first_not_of(" \t") == std::string::npos)
    return fail("the reason is missing");
  std::string what = text.substr(0, equals);
  const std::size_t colon = what.find(':');
  waiver.kind = what.substr(0, colon);
  if (waiver.kind.empty()) return fail("the kind is missing");
  if (colon == std::string::npos) return waiver;
  waiver.file = what.substr(colon + 1);
  const std::size_t last = waiver.file.rfind(':');
  if (last != std::string::npos) {
    const std::string digits = waiver.file.substr(last + 1);
    if (digits.empty() || digits.size() > 9 ||
        digits.find_first_not_of("0123456789") != std::string::npos || std::stoul(digits) == 0)
      return fail("'" + printable(digits) + "' is not a line number");
    waiver.line = static_cast<std::uint32_t>(std::stoul(digits));
    waiver.file.resize(last);
  }
  if (waiver.file.empty()) return fail("the file is missing");
  return waiver;
}

Expected<Baseline> read_baseline(const SourceText& text) {
  const auto fail = [&](const char* why) {
    return unexpected(make_error("input", "the baseline '" + printable(text.name()) + "' " + why +
                                              "; name a result.json or a SARIF file of aircut"));
  };
  const Json document = Json::parse(text.content(), nullptr, false);
  if (document.is_discarded() || !document.is_object()) return fail("is not JSON");
  Baseline out;
  try {
    if (document.contains("runs")) {
      count_sarif(document["runs"], out);
    } else if (document.contains("findings") && document.contains("aircut")) {
      count_rows(document["findings"], out);
      if (document.contains("accepted")) count_rows(document["accepted"], out);
    } else {
      return fail("is no report");
    }
  } catch (const Json::exception&) {  // a value of another type than ours
    return fail("has a form that is not known");
  }
  return out;
}

bool Acceptance::accept(const Diagnostic& message, const std::string& program,
                        const sim::Finding* finding, RunReport& report) {
  const auto keep = [&](const std::string& reason, bool baseline) {
    report.accepted.push_back({message, program, reason,
                               fingerprint_of(message, program, finding, report.folder), baseline});
    return true;
  };
  for (Waiver& waiver : rules_.waivers)
    if (matches(waiver, message, program)) {
      ++waiver.used;
      return keep(waiver.reason, false);
    }
  if (rules_.baseline.empty()) return false;
  const auto known = rules_.baseline.find(fingerprint_of(message, program, finding, report.folder));
  if (known == rules_.baseline.end() || known->second == 0) return false;
  --known->second;
  return keep("in the baseline", true);
}

bool Acceptance::is_raised(const std::string& kind) const {
  return std::find(rules_.raised.begin(), rules_.raised.end(), kind) != rules_.raised.end();
}

void Acceptance::apply(const std::string& program, std::vector<Diagnostic>& diagnostics,
                       std::vector<sim::Finding>& findings, std::vector<std::string>& unchecked,
                       RunReport& report) {
  std::erase_if(diagnostics, [&](const Diagnostic& d) {
    if (!accept(d, program, nullptr, report)) return false;
    std::erase(unchecked, told_as(d));
    return true;
  });
  std::erase_if(findings, [&](const sim::Finding& f) {
    return accept(to_diagnostic(f, report), program, &f, report);
  });

  for (Diagnostic& d : diagnostics) {
    const bool strict = rules_.strict && makes_unknown(d.kind);
    if (strict || is_raised(d.kind)) d.severity = Severity::error;
  }
  for (sim::Finding& f : findings) {
    const bool strict = rules_.strict && (f.makes_unknown || f.unresolved);
    if (strict || is_raised(std::string(sim::to_string(f.kind)))) f.severity = Severity::error;
  }
  if (!rules_.strict) return;
  // What was not checked and has no message of its own gets one.
  for (const std::string& what : unchecked)
    if (std::none_of(diagnostics.begin(), diagnostics.end(),
                     [&](const Diagnostic& d) { return told_as(d) == what; }))
      diagnostics.push_back(make_error("not_checked", what));
}

void Acceptance::finish(RunReport& report) {
  for (const Waiver& waiver : rules_.waivers) {
    report.waivers.push_back(waiver);
    if (waiver.used == 0) {
      Diagnostic d = make_error(
          "waiver_unused", "the waiver '" + printable(waiver.text) + "' was not needed; remove it");
      d.severity = Severity::warning;
      report.diagnostics.push_back(std::move(d));
    }
  }
  if (!rules_.has_baseline) return;
  report.baseline_gone = 0;
  for (const auto& [print, count] : rules_.baseline) *report.baseline_gone += count;
}

}  // namespace aircut::report
