#include "peer/reference.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "peer/stand_in.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// Splits a line of a trace, `    8 N10    CALL(…)`; a line of the console is kept whole.
Call parse_line(const std::string& line) {
  std::size_t i = line.find_first_not_of(' ');
  std::size_t digits = i;
  while (digits < line.size() && std::isdigit(static_cast<unsigned char>(line[digits]))) ++digits;
  const bool is_call =
      i != std::string::npos && digits > i && digits >= 5 && line.compare(digits, 2, " N") == 0;
  if (!is_call) return {"PRINT " + line, ""};
  const std::size_t end_of_n = line.find(' ', digits + 2);
  const std::size_t call = line.find_first_not_of(' ', end_of_n);
  if (call == std::string::npos) return {"PRINT " + line, ""};
  std::string n = line.substr(digits + 2, end_of_n - digits - 2);
  if (n == ".....") n.clear();
  return {line.substr(call), n};
}

std::string name_of(const Call& call) { return call.text.substr(0, call.text.find_first_of("( ")); }

bool is_ignored(const Call& call) {
  static constexpr std::array ignored = {"START_CHANGE", "ON_RESET", "SET_TOOL_TABLE_ENTRY",
                                         "RELOAD_TOOLDATA", "FINISH"};
  const std::string name = name_of(call);
  if (std::find(ignored.begin(), ignored.end(), name) != ignored.end()) return true;
  if (name.starts_with("SPINDLE.")) return true;  // SPINDLE.0.WAIT_ORIENT_COMPLETE
  return call.text.starts_with("COMMENT(\"interpreter: ");
}

/// Both are rounded to four decimals, so they may be one step of the last decimal apart.
bool same_number(double a, double b) {
  return std::abs(a - b) <= std::max(1.5e-4, 1e-6 * std::abs(a));
}

bool same_call(const std::string& a, const std::string& b) {
  if (a == b) return true;
  // Text is compared byte by byte, arguments as numbers.
  if (a.find('"') != std::string::npos || b.find('"') != std::string::npos) return false;
  const auto is_number_part = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_number_part(a[i]) && is_number_part(b[j])) {
      const std::size_t i0 = i, j0 = j;
      while (i < a.size() && is_number_part(a[i])) ++i;
      while (j < b.size() && is_number_part(b[j])) ++j;
      const auto na = parse_number(a.substr(i0, i - i0)), nb = parse_number(b.substr(j0, j - j0));
      if (!na || !nb) {
        if (a.substr(i0, i - i0) != b.substr(j0, j - j0)) return false;
      } else if (!same_number(*na, *nb)) {
        return false;
      }
    } else if (a[i++] != b[j++]) {
      return false;
    }
  }
  return i == a.size() && j == b.size();
}

std::string ini_text(const std::string& folder, const std::string& sub_folder) {
  return "[EMC]\nVERSION=1.1\n[DISPLAY]\nPROGRAM_PREFIX=" + folder +
         "\n[RS274NGC]\nPARAMETER_FILE=" + folder + "/start.var\nSUBROUTINE_PATH=" + sub_folder +
         "\n[TRAJ]\nLINEAR_UNITS=inch\nSPINDLES=1\n";
}

}  // namespace

std::vector<Call> parse_trace(const std::string& text) {
  std::vector<Call> calls;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) calls.push_back(parse_line(line));
  return calls;
}

bool reference_is_installed() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((folder + "/rs274").c_str(), X_OK) == 0) return true;
  return false;
}

Reference::Reference(std::string folder, std::string sub_folder) : folder_(std::move(folder)) {
  fs::create_directories(folder_);
  write_file(fs::path(folder_) / "machine.ini", ini_text(folder_, sub_folder));
}

Trace Reference::run(const ProgramFile& program) {
  const fs::path folder(folder_);
  const bool block_delete = program.options.block_delete;
  if (!server_ || tools_ != program.tools || block_delete_ != block_delete) {
    tools_ = program.tools;
    block_delete_ = block_delete;
    write_file(folder / "tool.tbl", tools_);
    server_.reset();
    server_.emplace(folder_, block_delete);
  }
  write_file(folder / "program.ngc", program.text);
  std::string var;
  for (const auto& [number, value] : program.parameters.values)
    var += std::to_string(number) + "\t" + fixed(value, 6) + "\n";
  write_file(folder / "start.var", var);
  const int status = server_->run();
  std::string said = read_file(folder / "stderr");
  Trace trace;
  trace.calls = parse_trace(read_file(folder / "stdout"));
  trace.error_text = said;
  // Killed by its alarm clock, or for the length of its trace.
  trace.timed_out =
      WIFSIGNALED(status) && (WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGXFSZ);
  trace.error = status != 0;
  return trace;
}

/// Kinds of problems that the reference meets at another line: where it gives up the search for the
/// other half of a construct.
bool ends_where_it_stands(const std::string& kind) {
  static constexpr std::array elsewhere = {"label_missing", "program_end_missing", "sub_missing",
                                           "flow_nesting",  "percent_missing",     "path_refused"};
  return std::find(elsewhere.begin(), elsewhere.end(), kind) == elsewhere.end();
}

/// Line `number` without blanks around it, or nothing for line 0.
std::string line_of(const std::string& text, std::uint64_t number) {
  std::istringstream in(text);
  std::string line;
  for (std::uint64_t i = 0; i < number; ++i) std::getline(in, line);
  const auto first = line.find_first_not_of(" \t");
  return first == std::string::npos ? std::string()
                                    : line.substr(first, line.find_last_not_of(" \t") - first + 1);
}

Trace own_trace(const ProgramFile& program, const std::string& sub_folder) {
  StandInProbe probe;
  Outcome outcome = run_program(program, false, sub_folder, [&](const canon::Command& command) {
    return probe.follow(command);
  });
  Trace trace;
  trace.codes = std::move(outcome.codes);
  trace.calls = parse_trace(outcome.rs274);
  bool too_deep = false;
  for (const Outcome::Found& found : outcome.found) {
    if (found.severity != Severity::error) continue;
    if (!trace.error) trace.error_at = found.line;
    if (!trace.error && ends_where_it_stands(found.kind))
      trace.error_line = line_of(program.text, found.line);
    trace.error = true;
    trace.error_text += found.text + "\n";
    too_deep = too_deep || found.kind == "call_depth";
  }
  trace.timed_out = outcome.stopped_by_limit && !too_deep;
  return trace;
}

std::vector<Call> comparable(const Trace& trace) {
  std::vector<Call> calls = trace.calls;
  // The start state ends with the first ON_RESET.
  const auto start = std::find_if(calls.begin(), calls.end(),
                                  [](const Call& c) { return name_of(c) == "ON_RESET"; });
  if (start != calls.end()) calls.erase(calls.begin(), start + 1);
  std::erase_if(calls, is_ignored);
  return calls;
}

std::optional<std::string> difference(const Trace& own, const Trace& reference) {
  const std::vector<Call> a = comparable(own), b = comparable(reference);
  std::size_t common = std::min(a.size(), b.size());
  const bool endless = own.timed_out && reference.timed_out;
  if (endless && common > 0) --common;  // where one of them was cut off
  for (std::size_t i = 0; i < common; ++i)
    if (!same_call(a[i].text, b[i].text))
      return "call " + std::to_string(i + 1) + "\n    own:       " + a[i].text +
             "\n    reference: " + b[i].text +
             (own.error != reference.error ? "\n    own errors: " + own.error_text +
                                                 "\n    reference's:  " + reference.error_text
                                           : "");
  if (endless) return std::nullopt;
  if (own.error != reference.error)
    return own.error ? "only own refuses: " + own.error_text +
                           (b.size() > common ? "\n    reference: " + b[common].text : "")
                     : "only the reference refuses: " + reference.error_text;
  if (own.timed_out != reference.timed_out)
    return std::string("only ") + (own.timed_out ? "own" : "the reference") + " never ends";
  // It cuts long lines off.
  if (own.error && reference.error_text.find(own.error_line.substr(0, 200)) == std::string::npos)
    return "refused at another line: " + own.error_text +
           "\n    reference's: " + reference.error_text;
  const std::string errors = own.error ? "\n    own error: " + own.error_text +
                                             "\n    reference's: " + reference.error_text
                                       : "";
  if (a.size() > b.size()) return "only own has: " + a[common].text + errors;
  if (b.size() > a.size()) {
    // The reference prints a refused block's calls up to its error; a block of ours gives nothing.
    // Those calls belong to one block.
    if (!own.error) return "only the reference has: " + b[common].text;
    for (std::size_t i = common; i < b.size(); ++i)
      if (b[i].n != b[common].n || i - common > 60)
        return "stopped at an earlier line than the reference, which has: " + b[common].text +
               errors;
  }
  return std::nullopt;
}

std::string shrink(const std::string& program,
                   const std::function<bool(const std::string&)>& differs, int budget) {
  std::vector<std::string> lines;
  std::istringstream in(program);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto joined = [](const std::vector<std::string>& parts) {
    std::string out;
    for (const std::string& part : parts) out += part + "\n";
    return out;
  };
  for (std::size_t chunk = std::max<std::size_t>(1, lines.size() / 2); budget > 0;) {
    bool removed = false;
    for (std::size_t at = 0; at < lines.size() && budget > 0;) {
      std::vector<std::string> fewer = lines;
      const std::size_t end = std::min(at + chunk, fewer.size());
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at),
                  fewer.begin() + static_cast<std::ptrdiff_t>(end));
      --budget;
      if (differs(joined(fewer))) {
        lines = std::move(fewer);
        removed = true;
      } else {
        at += chunk;
      }
    }
    if (chunk == 1 && !removed) break;
    if (chunk > 1) chunk /= 2;
  }
  return joined(lines);
}

}  // namespace aircut::test
