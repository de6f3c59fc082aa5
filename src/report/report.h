// report: what a run says, as text for people and as JSON, and the pictures that go with it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/frames.h"
#include "sim/sim.h"

namespace aircut::report {

struct Input {
  std::string role;  ///< program, machine, tools, setup, parameters
  std::string path;  ///< as the user wrote it
  std::string sha256;
};

/// Everything that a run ends with.
struct RunReport {
  std::string version;
  std::string machine;  ///< name of the machine; empty when none was needed
  std::vector<Input> inputs;
  std::vector<std::string> checks;         ///< asked for: syntax, limits, collision, …
  std::map<std::string, double> settings;  ///< near_mm, period_s, …
  std::vector<Diagnostic> diagnostics;     ///< of the program and of inputs
  std::vector<sim::Finding> findings;
  sim::Summary summary;
  std::vector<std::string> joint_names;
  std::vector<bool> joint_rotary;
  std::vector<std::string> outputs;  ///< relative to the output folder
};

/// schema 1; one document, keys in a fixed order, ends with a line end.
std::string to_json(const RunReport& report);

/// A finding as a message: excerpt, times, joints, state, remedy.
Diagnostic to_diagnostic(const sim::Finding& finding, const RunReport& report);

struct HumanOptions {
  TextStyle style;
  std::size_t most = 100;  ///< messages that are printed; all are counted
  bool quiet = false;      ///< only the verdict
};
/// What was not checked, then the messages (one per episode), then the summary.
std::string to_human(const RunReport& report, const HumanOptions& options);
/// One line per message, `file:line:column: severity: text [kind]`.
std::string to_gcc(const RunReport& report);
/// GitHub workflow annotations.
std::string to_github(const RunReport& report);

}  // namespace aircut::report
