#include "peer/reference.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

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

/// Runs a command with its outputs in files; gives its exit status.
int run_command(std::vector<std::string> words, const fs::path& folder) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = folder / "stdout", err = folder / "stderr", in = folder.string();
  const pid_t child = ::fork();
  if (child < 0) return -1;
  if (child == 0) {
    const int out_fd = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_fd = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int null_fd = ::open("/dev/null", O_RDONLY);
    if (out_fd < 0 || err_fd < 0 || null_fd < 0 || ::chdir(in.c_str()) != 0) ::_exit(126);
    // It keeps its tools in a file in the home folder, which all runs would share.
    ::setenv("HOME", in.c_str(), 1);
    ::dup2(null_fd, 0);
    ::dup2(out_fd, 1);
    ::dup2(err_fd, 2);
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
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

std::vector<Call> parse_trace(const std::string& text) {
  std::vector<Call> calls;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) calls.push_back(parse_line(line));
  return calls;
}

std::string name_of(const Call& call) { return call.text.substr(0, call.text.find_first_of("( ")); }

bool is_ignored(const Call& call) {
  static constexpr std::array ignored = {"START_CHANGE", "ON_RESET", "SET_TOOL_TABLE_ENTRY",
                                         "FINISH"};
  const std::string name = name_of(call);
  if (std::find(ignored.begin(), ignored.end(), name) != ignored.end()) return true;
  if (name.starts_with("SPINDLE.")) return true;  // SPINDLE.0.WAIT_ORIENT_COMPLETE
  return call.text.starts_with("COMMENT(\"interpreter: ");
}

/// What an end of program may print beside PROGRAM_END.
bool is_reset(const Call& call) {
  static constexpr std::array resets = {"SET_G5X_OFFSET",
                                        "SET_G92_OFFSET",
                                        "SET_XY_ROTATION",
                                        "SELECT_PLANE",
                                        "SET_FEED_MODE",
                                        "SET_FEED_RATE",
                                        "STOP_SPINDLE_TURNING",
                                        "SET_SPINDLE_MODE",
                                        "MIST_OFF",
                                        "FLOOD_OFF",
                                        "ENABLE_FEED_OVERRIDE",
                                        "ENABLE_SPEED_OVERRIDE",
                                        "DISABLE_ADAPTIVE_FEED",
                                        "ENABLE_FEED_HOLD",
                                        "PALLET_SHUTTLE",
                                        "PROGRAM_END"};
  return std::find(resets.begin(), resets.end(), name_of(call)) != resets.end();
}

bool ends_program(const std::vector<Call>& calls) {
  return std::any_of(calls.begin(), calls.end(),
                     [](const Call& c) { return name_of(c) == "PROGRAM_END"; });
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

Trace Reference::run(const ProgramFile& program) const {
  const fs::path folder(folder_);
  write_file(folder / "tool.tbl", program.tools);
  write_file(folder / "program.ngc", program.text);
  std::string var;
  for (const auto& [number, value] : program.parameters.values)
    var += std::to_string(number) + "\t" + fixed(value, 6) + "\n";
  write_file(folder / "start.var", var);
  std::vector<std::string> words = {"timeout",     "-k", "1",        "10", "rs274",    "-i",
                                    "machine.ini", "-t", "tool.tbl", "-v", "start.var"};
  if (program.options.block_delete) words.push_back("-b");
  words.insert(words.end(), {"-g", "program.ngc"});
  const int status = run_command(words, folder);
  std::string said = read_file(folder / "stderr");
  if (said.starts_with("executing\n")) said.erase(0, 10);
  Trace trace;
  trace.calls = parse_trace(read_file(folder / "stdout"));
  trace.error_text = said;
  trace.timed_out = status == 124 || status == 137;
  trace.error = status != 0;
  return trace;
}

Trace own_trace(const ProgramFile& program, const std::string& sub_folder) {
  const Outcome outcome = run_program(program, false, sub_folder);
  Trace trace;
  trace.calls = parse_trace(outcome.rs274);
  bool too_deep = false;
  for (const Outcome::Found& found : outcome.found) {
    if (found.severity != Severity::error) continue;
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
  if (!trace.error && ends_program(calls))
    while (!calls.empty() && is_reset(calls.back())) calls.pop_back();
  return calls;
}

std::optional<std::string> difference(const Trace& own, const Trace& reference) {
  if (own.timed_out && reference.timed_out) return std::nullopt;  // both never end
  const std::vector<Call> a = comparable(own), b = comparable(reference);
  const std::size_t common = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < common; ++i)
    if (!same_call(a[i].text, b[i].text))
      return "call " + std::to_string(i + 1) + "\n    own:       " + a[i].text +
             "\n    reference: " + b[i].text +
             (own.error != reference.error ? "\n    own errors: " + own.error_text +
                                                 "\n    reference's:  " + reference.error_text
                                           : "");
  if (own.error != reference.error)
    return own.error ? "only own refuses: " + own.error_text +
                           (b.size() > common ? "\n    reference: " + b[common].text : "")
                     : "only the reference refuses: " + reference.error_text;
  if (own.timed_out != reference.timed_out)
    return std::string("only ") + (own.timed_out ? "own" : "the reference") + " never ends";
  if (a.size() > b.size()) return "only own has: " + a[common].text;
  if (b.size() > a.size()) {
    // The reference prints a refused block's calls up to its error; a block of ours gives nothing.
    // Those calls belong to one block.
    if (!own.error) return "only the reference has: " + b[common].text;
    for (std::size_t i = common; i < b.size(); ++i)
      if (b[i].n != b[common].n || i - common > 60)
        return "stopped at an earlier line than the reference, which has: " + b[common].text +
               "\n    own error: " + own.error_text + "\n    reference's: " + reference.error_text;
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
