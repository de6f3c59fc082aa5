// report: what a run says, as text for people and for programs, and the pictures that go with it.
// Text of inputs is escaped by every format, and what was not checked comes first in each.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/deviation.h"
#include "report/frames.h"
#include "sim/sim.h"

namespace aircut::report {

struct Input {
  std::string role;  ///< program, machine, tools, setup, parameters
  std::string path;  ///< as the user wrote it
  std::string sha256;
};

/// One of many programs that were checked in one go: its own verdict, and which of the report's
/// diagnostics are its.
struct Unit {
  std::string program;  ///< as the user wrote it
  sim::Verdict verdict = sim::Verdict::unknown;
  std::uint64_t blocks = 0, moves = 0;
  std::vector<std::string> unchecked;
  std::size_t first = 0, count = 0;  ///< range in RunReport::diagnostics
  bool limit_reached = false;        ///< of the interpreter
};

/// What a user accepts (--waive), and why.
struct Waiver {
  std::string kind;
  std::string file;        ///< as messages name it, or the end of that after a `/`; empty: any
  std::uint32_t line = 0;  ///< 0: any
  std::string reason;
  std::string text;      ///< as written
  std::size_t used = 0;  ///< messages that it has accepted
};

/// A message that a waiver or a baseline has accepted. It fails nothing.
struct Accepted {
  Diagnostic message;
  std::string program;
  std::string reason;
  std::string fingerprint;
  bool baseline = false;  ///< it was in an earlier report
};

/// The most that a joint does, by differences of the joint log's rows.
struct JointPeak {
  struct At {
    double value = 0;  ///< per s, s², s³
    double t = 0;      ///< s
    std::uint64_t line = 0;
  };
  std::string joint, unit;  ///< mm or deg
  At speed, acceleration, jerk;
};

/// A part of the program, from a comment or a tool change on.
struct Operation {
  std::string name;  ///< the comment; empty when there is none
  std::uint64_t line = 0;
  int tool = 0;     ///< the last one in the spindle during it
  double time = 0;  ///< s, all of it; of which …
  double feed = 0, rapid = 0, tool_change = 0;
};

/// One of several channels that have run at once.
struct ChannelRow {
  std::string name, program;
  double time = 0, waiting = 0;  ///< s: until its end, and of that at wait codes
  std::uint64_t blocks = 0, moves = 0;
};

struct AccuracyAlong;  // report/accuracy_along.h

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
  std::map<std::string, double> held_by;          ///< s, by what held the speed; empty: not known
  std::vector<Operation> operations;              ///< with time, in order
  std::vector<JointPeak> peaks;                   ///< empty without a joint log of every sample
  std::shared_ptr<const AccuracyAlong> accuracy;  ///< null when it was not asked for
  std::optional<JointPeak::At> chord_error;       ///< mm; nothing without such a log
  std::vector<ChannelRow> channels;               ///< empty when there was just one
  plan::Statistics planner;
  std::vector<std::string> outputs;          ///< relative to the output folder
  std::vector<Unit> units;                   ///< empty when there was one program
  std::vector<Accepted> accepted;            ///< not among diagnostics and findings
  std::vector<Waiver> waivers;               ///< all that were given
  std::optional<std::size_t> baseline_gone;  ///< of the baseline, what was not found again
  std::string folder;         ///< where paths in fingerprints begin, absolute; empty: as written
  std::string unknown_cause;  ///< `input`, `limit`, `usage`, `output`; empty: something unchecked
  std::optional<Severity> fail_on = Severity::error;  ///< from here on the verdict is `fail`
};

/// Why the exit code is what it is: ok, findings, unchecked, limit, input, usage, output,
/// interrupted.
std::string cause_of(const RunReport& report);

/// schema 1; one document, keys in a fixed order, ends with a line end.
std::string to_json(const RunReport& report);
/// The same items, one per line; the last is the summary, without which the rest is not to be
/// trusted.
std::string to_jsonl(const RunReport& report);
/// Its parts, for messages that are written as they happen: the head; what one program gives (its
/// inputs too, if `with_inputs`); the summary.
std::string jsonl_head(const RunReport& report);
std::string jsonl_messages(const RunReport& report, bool with_inputs);
std::string jsonl_summary(const RunReport& report);

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

/// JUnit XML: a suite per program, a case per kind of message and one that asks whether everything
/// was checked.
std::string to_junit(const RunReport& report);

struct SarifOptions {
  std::vector<KindText> kinds;  ///< texts of the rules
  std::string folder;           ///< absolute paths below it are written relative to it
  std::size_t most = 25'000;    ///< results that are written; all are counted
};
/// SARIF 2.1.0.
std::string to_sarif(const RunReport& report, const SarifOptions& options);

/// 3MF (a zip archive with the unit in it), mm. The same mesh gives the same bytes.
std::string three_mf_bytes(const TriangleMesh& mesh);

}  // namespace aircut::report
