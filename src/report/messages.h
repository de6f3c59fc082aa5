// What every format says, before it is put into a form.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace aircut::report {

/// One message: a diagnostic of an input, or a finding of the run.
struct Message {
  Diagnostic text;
  std::string program;                    ///< whose it is; empty for inputs that all share
  const sim::Finding* finding = nullptr;  ///< null for diagnostics; owned by the report
  bool makes_unknown = false;             ///< something could not be proven because of it
};

/// `rows`: one per block and contact. `episodes`: one for each continuous contact, as people want
/// it.
enum class Take { rows, episodes };
std::vector<Message> messages(const RunReport& report, Take take);

/// At or above the level at which the verdict is `fail`.
bool fails(const Message& message, const RunReport& report);

/// What was not checked and has no finding of its own, in words, one line each (not yet escaped).
std::vector<std::string> unchecked_besides_findings(const RunReport& report);
/// Everything that was not checked: those, and the findings that say so.
std::vector<std::string> unchecked(const RunReport& report);

/// The programs of the report; of a run its only one.
std::vector<Unit> units_of(const RunReport& report);

}  // namespace aircut::report
