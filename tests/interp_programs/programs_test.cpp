// Runs every program of programs/ and compares what each line gives with what its comments say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>

#include "interp/code_table.h"
#include "interp/codes/codes.h"
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
  interp::read_var(sources.add("a.var", "5221 1\n5161 2\ntext\n"), diagnostics);
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

// A row that is added without a program that executes it fails here.
TEST(Programs, ExecuteEveryRowOfTheCodeTable) {
  std::map<std::string, std::uint64_t> executed;
  for (const ProgramFile& program : read_program_folder(folder))
    for (const auto& [code, count] : run_program(program, true, folder + "/subs").codes)
      executed[code] += count;
  for (const interp::CodeRule* rule : interp::CodeTable().rules()) {
    if (!rule->handler) continue;  // an `unsupported_code` error
    EXPECT_GT(executed[interp::name_of(*rule)], 0u) << name_of(*rule) << " has no program";
  }
}

struct Control {
  const char* name;
  interp::Dialect dialect;
  bool lathe;
};
constexpr Control other_controls[] = {{"Fanuc mill", interp::Dialect::fanuc, false},
                                      {"Fanuc lathe", interp::Dialect::fanuc, true},
                                      {"Haas mill", interp::Dialect::haas, false},
                                      {"Haas lathe", interp::Dialect::haas, true}};

// What the control's builder gives a meaning is one row for each of a thousand numbers.
bool is_of_the_builder(const interp::CodeRule& rule) {
  return rule.handler == interp::builder_code;
}

// Controls share rows, so a row is executed when a program of any of them does it. What a row can
// do may be to refuse its line with a reason of its own.
TEST(Programs, ExecuteEveryRowOfTheOtherControls) {
  std::set<const interp::CodeRule*> executed;
  for (const ProgramFile& program : read_program_folder(fanuc_folder)) {
    const Outcome outcome = run_program(program, true, folder + "/subs");
    const auto refused = [&](const std::string& code) {
      return std::any_of(outcome.found.begin(), outcome.found.end(), [&](const auto& found) {
        return found.kind == "unsupported_code" &&
               found.text.find("error: " + code + " ") != std::string::npos;
      });
    };
    for (const interp::CodeRule* rule :
         interp::CodeTable(program.options.dialect, program.options.lathe).rules()) {
      const std::string code = interp::name_of(*rule);
      const auto found = outcome.codes.find(code);
      if ((found != outcome.codes.end() && found->second > 0) || refused(code))
        executed.insert(rule);
    }
  }
  for (const Control& control : other_controls)
    for (const interp::CodeRule* rule : interp::CodeTable(control.dialect, control.lathe).rules())
      if (rule->handler && !is_of_the_builder(*rule)) {
        EXPECT_TRUE(executed.contains(rule))
            << name_of(*rule) << " of a " << control.name << " has no program";
      }
  EXPECT_TRUE(std::any_of(executed.begin(), executed.end(),
                          [](const auto* rule) { return is_of_the_builder(*rule); }));
}

TEST(Programs, AreRefusedAtEveryCodeThatIsNotImplemented) {
  int refused = 0;
  for (const Control& control : other_controls)
    for (const interp::CodeRule* rule : interp::CodeTable(control.dialect, control.lathe).rules()) {
      if (rule->handler) continue;
      ProgramFile program =
          read_program_file("refused", "O1\nG0 X1.\n" + name_of(*rule) + "\nM30\n", "T1 P1\n");
      program.options.dialect = control.dialect;
      program.options.lathe = control.lathe;
      const Outcome outcome = run_program(program, true, folder + "/subs");
      ++refused;
      ASSERT_EQ(outcome.found.size(), 1u) << name_of(*rule) << " of a " << control.name;
      EXPECT_EQ(outcome.found[0].kind, "unsupported_code") << outcome.found[0].text;
      EXPECT_EQ(outcome.found[0].line, 3u);
    }
  EXPECT_GT(refused, 100);
}

/// Codes of a cell of docs/fanuc-codes.md: `G5.1, Haas G15, M10-M18`.
std::set<std::string> codes_in(const std::string& cell) {
  static const std::regex code(R"(([GM])(\d+)(?:\.(\d))?(?:-([GM])(\d+)(?:\.(\d))?)?)");
  std::set<std::string> codes;
  for (std::sregex_iterator at(cell.begin(), cell.end(), code), end; at != end; ++at) {
    const std::smatch& m = *at;
    const auto tenths = [](const std::string& whole, const std::string& part) {
      return std::stoi(whole) * 10 + (part.empty() ? 0 : std::stoi(part));
    };
    const int first = tenths(m[2], m[3]);
    const int last = m[4].matched ? tenths(m[5], m[6]) : first;
    const int step = m[3].matched ? 1 : 10;
    for (int number = first; number <= last; number += step) {
      std::string name = m[1].str() + std::to_string(number / 10);
      if (number % 10) name += "." + std::to_string(number % 10);
      codes.insert(name);
    }
  }
  return codes;
}

// The page says which codes are accepted without effect and which are refused; so do the rows.
TEST(Documentation, NamesTheCodesThatAreAcceptedOrRefused) {
  std::ifstream in(AIRCUT_SOURCE_DIR "/docs/fanuc-codes.md");
  std::set<std::string> accepted, refused;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| G")) continue;
    const std::size_t second = line.find('|', 1);
    const std::string codes = line.substr(0, second), becomes = line.substr(second + 2);
    if (becomes.starts_with("accepted")) accepted.merge(codes_in(codes));
    if (becomes.starts_with("refused:")) refused.merge(codes_in(codes));
  }
  std::set<std::string> accepts, refuses;
  for (const Control& control : other_controls)
    for (const interp::CodeRule* rule : interp::CodeTable(control.dialect, control.lathe).rules()) {
      if (!rule->handler) refuses.insert(name_of(*rule));
      if (rule->handler == interp::accepted) accepts.insert(name_of(*rule));
    }
  const auto missing = [](const std::set<std::string>& from, const std::set<std::string>& there) {
    std::vector<std::string> codes;
    std::set_difference(from.begin(), from.end(), there.begin(), there.end(),
                        std::back_inserter(codes));
    return joined(codes, " ");
  };
  EXPECT_EQ(missing(accepts, accepted), "nothing") << "not named as accepted";
  EXPECT_EQ(missing(accepted, accepts), "nothing") << "named as accepted";
  EXPECT_EQ(missing(refuses, refused), "nothing") << "not named as refused";
  EXPECT_EQ(missing(refused, refuses), "nothing") << "named as refused";
}

/// Programs that never end by themselves.
TEST(Programs, ThatNeverEndAreStopped) {
  const std::map<std::string, std::string> programs = {
      {"o1 do\n#1=[#1+1]\no1 while [1]\nM2\n", "loop_limit"},
      {"o1 while [#<_x> GE 0]\nG91 G0 X1\no1 endwhile\nM2\n", "loop_limit"},
      {"o1 repeat [9999999999*9999999999]\no1 endrepeat\nM2\n", "loop_limit"},
      {"o1 repeat [1000000000000000000]\nG0 X1\no1 endrepeat\nM2\n", "loop_limit"},
      {"o1 while [1]\no2 while [1]\no2 endwhile\no1 endwhile\nM2\n", "loop_limit"},
      {"o1 sub\no1 call\no1 endsub\no1 call\nM2\n", "call_depth"},
      {"o1 sub\no2 call\no1 endsub\no2 sub\no1 call\no2 endsub\no1 call\nM2\n", "call_depth"},
      {"o<again> call\nM2\n", "call_depth"},
      {"M98 P1\nM2\nO1\nM98 P1\nM99\n", "call_depth"},
      {"M98 P1 L999999999\nM2\nO1\n#1=[#1+1]\nM99\n", "limit_reached"},
      {"M98 P1 L999999999\nM2\nO1\nG0 X1\nM99\n", "limit_reached"},
      {"o1 do\no1 continue\no1 while [1]\nM2\n", "loop_limit"},
      {"o1 while [1]\no1 continue\no1 endwhile\nM2\n", "loop_limit"}};
  for (const auto& [text, kind] : programs) {
    ProgramFile program = read_program_file("endless", text, "T1 P1\n");
    program.options.limits.max_blocks = 100'000;
    program.options.limits.max_idle_blocks = 50'000;
    program.options.limits.max_repeat = 60'000;
    const Outcome outcome = run_program(program, true, folder + "/subs");
    ASSERT_EQ(outcome.found.size(), 1u) << text;
    EXPECT_EQ(outcome.found[0].kind, kind) << text << outcome.found[0].text;
    EXPECT_TRUE(outcome.stopped_by_limit) << text;
    EXPECT_FALSE(outcome.found[0].text.starts_with("error")) << "no place: " << text;
    // A loop is told with what its condition sees.
    if (text.find("#<_x>") != std::string::npos) {
      EXPECT_NE(outcome.found[0].text.find("#<_x> ="), std::string::npos) << outcome.found[0].text;
    }
  }
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
