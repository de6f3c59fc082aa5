// Runs every program of programs/ and compares what each line gives with what its comments say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>

#include "interp_programs/program_file.h"

namespace aircut::test {
namespace {

const std::string folder = AIRCUT_SOURCE_DIR "/tests/interp_programs/programs";
const std::string fanuc_folder = AIRCUT_SOURCE_DIR "/tests/interp_programs/fanuc";

std::vector<ProgramFile> all_programs() {
  std::vector<ProgramFile> all = read_program_folder(folder);
  for (ProgramFile& program : read_program_folder(fanuc_folder)) all.push_back(std::move(program));
  return all;
}

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : separator) + part;
  return out.empty() ? "nothing" : out;
}

/// A comment for this test, which the interpreter takes for one of the program.
bool is_remark(const std::string& text) {
  for (const char* mark : {"expect:", "then:", "error:", "warning:", "file-error:", "!"})
    if (text.starts_with(std::string("comment ") + mark)) return true;
  return false;
}

/// What came out, by line of the program.
std::map<std::uint64_t, Expectation> by_line(const Outcome& outcome) {
  std::map<std::uint64_t, Expectation> lines;
  for (const canon::Command& command : outcome.commands) {
    if (command.block == 0 || command.span.line == 0) continue;
    std::string said = canon::to_text(command.action);
    if (is_remark(said)) continue;
    auto& commands = lines[command.span.line].commands;
    if (!commands) commands.emplace();
    commands->push_back(std::move(said));
  }
  for (const Outcome::Found& found : outcome.found) {
    auto& line = lines[found.line];
    if (found.severity == Severity::error || found.kind == "loop_limit")
      line.errors.push_back(found.kind);
    if (found.severity != Severity::error) line.warnings.push_back(found.kind);
  }
  return lines;
}

bool same_commands(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_text);
}

/// Fails for each line that gives something else than it says. Returns how many lines said
/// something.
int compare(const ProgramFile& program) {
  EXPECT_EQ(program.bad_syntax, "") << program.name;
  const Outcome outcome = run_program(program, true, folder + "/subs");
  const auto is_limit = [](const auto& found) {
    return found.kind == "call_depth" || found.kind == "loop_limit";
  };
  EXPECT_EQ(outcome.stopped_by_limit,
            std::any_of(outcome.found.begin(), outcome.found.end(), is_limit))
      << program.name;
  std::map<std::uint64_t, Expectation> got = by_line(outcome);
  std::set<std::uint64_t> numbers;
  for (const auto& [number, line] : program.lines) numbers.insert(number);
  for (const auto& [number, line] : got) numbers.insert(number);
  int said = 0;
  for (const std::uint64_t number : numbers) {
    const std::string place = program.name + ".ngc:" + std::to_string(number);
    const auto found = program.lines.find(number);
    const Expectation expected = found == program.lines.end() ? Expectation() : found->second;
    const Expectation& is = got[number];
    said += expected.commands.has_value() + !expected.errors.empty();
    if (expected.commands) {
      const auto commands = is.commands.value_or(std::vector<std::string>());
      EXPECT_TRUE(same_commands(*expected.commands, commands))
          << place << "\n  must give " << joined(*expected.commands, " | ") << "\n  but gives "
          << joined(commands, " | ");
    }
    EXPECT_TRUE(expected.errors == is.errors)
        << place << "\n  errors must be " << joined(expected.errors, ", ") << "\n  but are "
        << joined(is.errors, ", ") << "; it gives "
        << joined(is.commands.value_or(std::vector<std::string>()), " | ");
    if (!expected.warnings.empty()) {
      EXPECT_TRUE(expected.warnings == is.warnings)
          << place << "\n  warnings must be " << joined(expected.warnings, ", ") << "\n  but are "
          << joined(is.warnings, ", ");
    }
    if (!expected.errors.empty() && !expected.commands) {
      EXPECT_FALSE(is.commands) << place << " is refused, so it must give nothing";
    }
  }
  return said;
}

std::vector<ProgramFile> programs() {
  const char* only = std::getenv("AIRCUT_PROGRAM");
  std::vector<ProgramFile> all = all_programs();
  if (only)
    std::erase_if(all,
                  [&](const ProgramFile& p) { return p.name.find(only) == std::string::npos; });
  return all;
}

TEST(Programs, GiveWhatTheirCommentsSay) {
  int said = 0;
  for (const ProgramFile& program : programs()) said += compare(program);
  EXPECT_GT(said, 0);
}

/// Kinds of what no program with comments can show: texts that are none.
std::set<std::string> kinds_of_broken_texts() {
  std::set<std::string> kinds;
  const std::string texts[] = {"",
                               std::string("\xff\xfeG\0"
                                           "0\0",
                                           6),
                               "\xef\xbb\xbfM2\n", std::string("\0\0\0\0\1\2", 6)};
  for (const std::string& text : texts) {
    ProgramFile program = read_program_file("broken", text, "T1 P1\n");
    const Outcome outcome = run_program(program, true, folder + "/subs");
    EXPECT_FALSE(outcome.found.empty());
    for (const Outcome::Found& found : outcome.found) kinds.insert(found.kind);
  }
  SourceMap sources;
  Diagnostics diagnostics;
  interp::read_var(sources.add("a.var", "5221 1\n5161 2\n"), diagnostics);
  EXPECT_EQ(diagnostics.errors(), 1u);
  for (const Diagnostic& d : diagnostics.list()) kinds.insert(d.kind);
  return kinds;
}

TEST(Programs, ProvokeEveryKindOfError) {
  std::set<std::string> provoked = kinds_of_broken_texts();
  for (const ProgramFile& program : all_programs()) {
    for (const auto& [number, line] : program.lines) {
      provoked.insert(line.errors.begin(), line.errors.end());
      provoked.insert(line.warnings.begin(), line.warnings.end());
    }
  }
  for (const interp::KindText& kind : interp::error_kinds())
    EXPECT_TRUE(provoked.contains(kind.kind)) << kind.kind << " has no program that provokes it";
  std::set<std::string> known;
  for (const interp::KindText& kind : interp::error_kinds()) known.insert(kind.kind);
  for (const std::string& kind : provoked)
    EXPECT_TRUE(known.contains(kind)) << kind << " is not in the table of kinds";
}

/// The words of a program without its comments, in upper case and without blanks around them.
std::set<std::string> codes_in(const std::string& text) {
  std::set<std::string> codes;
  bool comment = false;
  std::string word;
  const auto finish = [&] {
    while (word.size() > 2 && word[1] == '0') word.erase(1, 1);
    if (word.size() > 1) codes.insert(word);
    word.clear();
  };
  for (const char c : text + "\n") {
    if (c == ';' || c == '(') comment = true;
    const char upper = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const bool goes_on = !word.empty() && ((upper >= '0' && upper <= '9') || upper == '.');
    if (!goes_on) finish();
    if (!comment && (goes_on || upper == 'G' || upper == 'M')) word += upper;
    if (c == ')' || c == '\n') comment = false;
  }
  return codes;
}

TEST(Programs, UseEveryCodeOfTheLanguage) {
  std::set<std::string> used;
  for (const ProgramFile& program : read_program_folder(folder)) used.merge(codes_in(program.text));
  const char* const codes[] = {
      "G0",    "G1",    "G2",    "G3",    "G4",    "G5",    "G5.1",  "G5.2",  "G5.3",  "G7",
      "G8",    "G10",   "G17",   "G17.1", "G18",   "G18.1", "G19",   "G19.1", "G20",   "G21",
      "G28",   "G28.1", "G30",   "G30.1", "G33",   "G33.1", "G38.2", "G38.3", "G38.4", "G38.5",
      "G40",   "G41",   "G41.1", "G42",   "G42.1", "G43",   "G43.1", "G43.2", "G49",   "G52",
      "G53",   "G54",   "G55",   "G56",   "G57",   "G58",   "G59",   "G59.1", "G59.2", "G59.3",
      "G61",   "G61.1", "G64",   "G73",   "G74",   "G76",   "G80",   "G81",   "G82",   "G83",
      "G84",   "G85",   "G86",   "G87",   "G89",   "G90",   "G90.1", "G91",   "G91.1", "G92",
      "G92.1", "G92.2", "G92.3", "G93",   "G94",   "G95",   "G96",   "G97",   "G98",   "G99",
      "M0",    "M1",    "M2",    "M3",    "M4",    "M5",    "M6",    "M7",    "M8",    "M9",
      "M19",   "M30",   "M48",   "M49",   "M50",   "M51",   "M52",   "M53",   "M60",   "M61",
      "M62",   "M63",   "M64",   "M65",   "M66",   "M67",   "M68",   "M70",   "M71",   "M72",
      "M73",   "M98",   "M99",   "M100"};
  for (const char* code : codes) EXPECT_TRUE(used.contains(code)) << code << " has no program";
}

TEST(Programs, GiveTheSameTwice) {
  for (const ProgramFile& program : programs())
    EXPECT_EQ(run_program(program, true, folder + "/subs").rs274,
              run_program(program, true, folder + "/subs").rs274)
        << program.name;
}

TEST(Comparing, OfTextsIgnoresTheLastDigits) {
  EXPECT_TRUE(same_text("rapid X1 Y0 Z-3", "rapid X1.00009 Y-0.00001 Z-3"));
  EXPECT_TRUE(same_text("feed X1000000", "feed X1000000.9"));
  EXPECT_FALSE(same_text("rapid X1", "rapid X1.001"));
  EXPECT_FALSE(same_text("rapid X1", "feed X1"));
  EXPECT_FALSE(same_text("rapid X1", "rapid Y1"));
  EXPECT_FALSE(same_text("rapid X1", "rapid X1 Y2"));
  EXPECT_FALSE(same_text("message a1b", "message a2b"));
}

}  // namespace
}  // namespace aircut::test
