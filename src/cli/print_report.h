// The report on stdout, in the form that was asked for.
#pragma once

#include "cli/arguments.h"
#include "report/report.h"

namespace aircut::cli {

/// All kinds of messages with their long text, sorted by kind.
std::vector<KindText> all_kinds();

/// Where aircut runs: paths in fingerprints and SARIF are relative to it.
std::string working_folder();

/// Text on stdout; false when it could not be written (a full disk).
[[nodiscard]] bool print_text(const std::string& text);
/// False when standard output could not be written.
[[nodiscard]] bool print_report(const report::RunReport& report, const OutputArguments& output);

}  // namespace aircut::cli
