// Which messages a user accepts, and which are worse than they are by themselves: --waive,
// --baseline, --raise, --strict. An accepted message fails nothing any more, but the report lists
// it with its reason.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/report.h"

namespace aircut::report {

/// `KIND[:FILE[:LINE]]=REASON`. Error (kind `usage`): another form, or no reason.
Expected<Waiver> read_waiver(const std::string& text);

/// How often each fingerprint stands in an earlier report: a result.json (its accepted ones too) or
/// a SARIF file. Error (kind `input`) at what is neither.
using Baseline = std::map<std::string, std::size_t>;
Expected<Baseline> read_baseline(const SourceText& text);

/// What the message is about and not where it stands (see fingerprint.cpp). Absolute paths below
/// `folder` are taken relative to it.
std::string fingerprint_of(const Diagnostic& message, const std::string& program,
                           const sim::Finding* finding, const std::string& folder);

struct Rules {
  std::vector<Waiver> waivers;
  Baseline baseline;
  bool has_baseline = false;
  std::vector<std::string> raised;  ///< kinds that are errors
  bool strict = false;              ///< what makes the verdict unknown is an error
};

/// Sees the messages of one program after the other.
class Acceptance {
 public:
  explicit Acceptance(Rules rules) : rules_(std::move(rules)) {}

  /// Takes the accepted ones out of the lists and puts them into `report.accepted`, and what is
  /// said about them out of `unchecked`; then raises the others. `report` has the joints' names.
  void apply(const std::string& program, std::vector<Diagnostic>& diagnostics,
             std::vector<sim::Finding>& findings, std::vector<std::string>& unchecked,
             RunReport& report);
  /// After the last program: which waivers were never needed, and how much of the baseline is gone.
  void finish(RunReport& report);

 private:
  bool accept(const Diagnostic& message, const std::string& program, const sim::Finding* finding,
              RunReport& report);
  bool is_raised(const std::string& kind) const;

  Rules rules_;
};

}  // namespace aircut::report
