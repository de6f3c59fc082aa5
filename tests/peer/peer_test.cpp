// Compares the interpreter with the reference program rs274, call by call: on the programs of
// tests/interp_programs, on LinuxCNC's own examples, and on programs made by chance.
// AIRCUT_NO_PEER=1 skips all of it where that program can't be had. AIRCUT_PEER_PROGRAMS=N sets the
// number of programs made by chance, AIRCUT_PEER_SEED the first seed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "peer/accepted.h"
#include "peer/generator.h"
#include "peer/reference.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

const std::string programs_folder =
    std::filesystem::absolute(AIRCUT_SOURCE_DIR "/tests/interp_programs/programs").string();
const std::string sub_folder = programs_folder + "/subs";

/// A difference without its numbers: `call own: DWELL reference: DWELL`, `only own refuses: …` with
/// the text that belongs to the refusal.
std::string kind_of(const std::string& difference) {
  std::string kind;
  std::istringstream in(difference);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("call ")) continue;
    const bool call = line.starts_with("    own: ") || line.starts_with("    reference: ");
    if (!call && !kind.empty() && !kind.starts_with("only own has") &&
        !kind.starts_with("stopped at"))
      break;
    const bool is_source = line.starts_with("N");  // the reference repeats the line
    if (is_source) continue;
    for (const char c : line) {
      if (call && c == '(') break;
      if (c < '0' || c > '9') kind += c;
    }
  }
  return kind.substr(0, 160);
}

/// Codes that the two can't be compared on, with docs/peer.md's reason.
const std::set<std::string> not_compared = {"G6",  "G6.1",  "G6.2",  "G6.3",  // newer
                                            "G70", "G71",   "G71.1", "G71.2",
                                            "G72", "G72.1", "G72.2",  // lathe roughing
                                            "M100"};                  // needs an installed program

int number_from(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

class Peer : public ::testing::Test {
 protected:
  void SetUp() override {
    if (number_from("AIRCUT_NO_PEER", 0) == 1) GTEST_SKIP() << "AIRCUT_NO_PEER=1";
    ASSERT_TRUE(reference_is_installed())
        << "rs274 is not installed (Debian: linuxcnc-uspace); AIRCUT_NO_PEER=1 skips these tests";
    // In memory where that is possible: each program is a handful of files.
    const fs::path memory = "/dev/shm";
    const fs::path parent =
        ::access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path();
    folder_ = parent / ("aircut_peer_" + std::to_string(::getpid()));
    reference_.emplace(folder_.string(), sub_folder);
  }
  void TearDown() override {
    reference_.reset();
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  Trace own(const ProgramFile& program) const {
    ProgramFile bounded = program;
    // A loop that never ends is cut off on both sides.
    bounded.options.limits.max_blocks = 2'000'000;
    bounded.options.limits.max_idle_blocks = 1'000'000;
    return own_trace(bounded, sub_folder);
  }
  std::optional<std::string> compare(const ProgramFile& program) {
    return difference(own(program), reference_->run(program));
  }

  /// How two traces compare once what docs/peer.md accepts is taken out.
  struct Comparison {
    std::optional<std::string> difference;
    std::vector<std::string> rules;  ///< that accepted something
  };
  Comparison compare_rest(ProgramFile program, Trace own_trace) {
    constexpr std::size_t most_excuses = 12;
    const bool strict = number_from("AIRCUT_PEER_STRICT", 0) == 1;
    Comparison result;
    while (true) {
      const Trace reference = reference_->run(program);
      result.difference = difference(own_trace, reference);
      if (!result.difference || strict || result.rules.size() == most_excuses) return result;
      const auto excuse = excuse_of(program.text, own_trace, reference, *result.difference);
      if (!excuse) return result;
      result.rules.push_back(excuse->rule);
      result.difference.reset();
      if (excuse->rest.empty()) return result;
      program.text = excuse->rest;
      own_trace = own(program);
    }
  }

  /// Reports a difference with the smallest program that still shows one.
  void report(const ProgramFile& program, const std::string& what) {
    // The same kind of difference, so that a shorter program doesn't drift to another one.
    const auto differs = [&](const std::string& text) {
      ProgramFile fewer = program;
      fewer.text = text;
      const auto found = compare_rest(fewer, own(fewer)).difference;
      return found && kind_of(*found) == kind_of(what);
    };
    ProgramFile small = program;
    small.text = shrink(program.text, differs, number_from("AIRCUT_PEER_SHRINK", 150));
    ADD_FAILURE() << program.name << " differs: " << what << "\n  smallest program:\n"
                  << small.text << "  gives: "
                  << compare_rest(small, own(small)).difference.value_or("no difference");
  }

  ProgramFile plain(const std::string& name, const std::string& text) const {
    ProgramFile program;
    program.name = name;
    program.text = text;
    program.options = reference_options();
    std::ifstream tools(programs_folder + "/tool.tbl");
    program.tools.assign(std::istreambuf_iterator<char>(tools), {});
    return program;
  }

  fs::path folder_;
  std::optional<Reference> reference_;
};

TEST_F(Peer, AgreesOnTheProgramsWithoutErrors) {
  int compared = 0;
  for (const ProgramFile& program : read_program_folder(programs_folder)) {
    if (!program.no_peer.empty() || program.expects_errors()) continue;
    ++compared;
    if (const auto what = compare(program)) report(program, *what);
  }
  EXPECT_GT(compared, 20);
}

// Each line that must be refused, alone behind the lines before it that are not: the reference
// stops at its first error, so one run shows one of them.
TEST_F(Peer, RefusesTheSameLines) {
  int compared = 0;
  for (const ProgramFile& program : read_program_folder(programs_folder)) {
    if (!program.no_peer.empty()) continue;
    for (const auto& [bad, expectation] : program.lines) {
      if (expectation.errors.empty() || bad == 0 || !expectation.peer_accepts.empty()) continue;
      ProgramFile one = program;
      one.text.clear();
      std::istringstream in(program.text);
      std::uint64_t number = 0;
      for (std::string line; std::getline(in, line);) {
        const auto found = program.lines.find(++number);
        const bool refused = found != program.lines.end() && !found->second.errors.empty();
        if (!refused || number == bad) one.text += line + "\n";
      }
      one.name += ":" + std::to_string(bad);
      ++compared;
      if (const auto what = compare(one)) report(one, *what);
    }
  }
  EXPECT_GT(compared, 20);
}

TEST_F(Peer, AgreesOnProgramsMadeByChance) {
  const int count = number_from("AIRCUT_PEER_PROGRAMS", 300);
  const int first = number_from("AIRCUT_PEER_SEED", 1);
  int with_errors = 0, accepted = 0;
  std::map<std::string, std::vector<std::uint32_t>> differing;  // seeds; the first is reported
  std::map<std::string, std::vector<std::uint32_t>> by_rule;
  std::map<std::string, std::uint64_t> codes;
  const auto most = static_cast<std::size_t>(number_from("AIRCUT_PEER_REPORTS", 10));
  int run = 0;
  for (int i = 0; i < count && differing.size() < most; ++i) {
    ++run;
    const auto seed = static_cast<std::uint32_t>(first + i);
    const ProgramFile program = plain("seed " + std::to_string(seed), generate_program(seed));
    const Trace trace = own(program);
    with_errors += trace.error;
    for (const auto& [code, executed] : trace.codes) codes[code] += executed;
    const Comparison compared = compare_rest(program, trace);
    if (!compared.difference) {
      for (const std::string& rule : compared.rules) by_rule[rule].push_back(seed);
      accepted += !compared.rules.empty();
      continue;
    }
    auto& seeds = differing[kind_of(*compared.difference)];
    seeds.push_back(seed);
    if (seeds.size() == 1) report(program, *compared.difference);
  }
  // Programs that are all refused at once would compare nothing.
  EXPECT_LT(with_errors, count * 2 / 3 + 1);
  EXPECT_LT(accepted, count / 20 + 1);
  std::string never;
  std::uint64_t least = ~std::uint64_t{0};
  for (const auto& [code, executed] : codes) {
    if (executed == 0 && !not_compared.contains(code)) never += " " + code;
    if (executed != 0) least = std::min(least, executed);
  }
  std::cout << run << " programs, " << with_errors << " of them refused, " << accepted
            << " with an accepted deviation; each code acted at least " << least
            << " times; never:" << (never.empty() ? " none" : never) << "\n";
  if (std::getenv("AIRCUT_PEER_CODES")) {
    for (const auto& [code, executed] : codes) std::cout << code << " " << executed << "\n";
    const auto list = [](const std::string& what, const std::vector<std::uint32_t>& seeds) {
      std::cout << seeds.size() << " times " << what << "\n   ";
      for (const std::uint32_t seed : seeds) std::cout << " " << seed;
      std::cout << "\n";
    };
    for (const auto& [rule, seeds] : by_rule) list("accepted: " + rule, seeds);
    for (const auto& [kind, seeds] : differing) list(kind, seeds);
  }
  if (count >= 1000) {
    EXPECT_EQ(never, "") << "codes that the generator never reaches";
  }
}

/// Examples that meet an accepted deviation (docs/peer.md).
std::string deviation_of(const std::string& example) {
  static const std::map<std::string, std::string> deviations = {
      {"mmount.ngc", "M6 with G43 in force"},
      {"skeleton.ngc", "M6 with G43 in force"},
      {"offsets.ngc", "M61"},
      {"smartprobe.ngc", "probing"},
      {"dyn_demo.ngc", "M100-M199"},
      {"eoffsets.ngc", "M100-M199"},
      {"jwp_z.ngc", "M100-M199"},
      {"opa_demo.ngc", "M100-M199"},
      {"xyzc.ngc", "M100-M199"},
      {"imperial_material_change.ngc", "M100-M199"},
      {"metric_material_change.ngc", "M100-M199"},
  };
  const auto found = deviations.find(example);
  return found == deviations.end() ? std::string() : found->second;
}

TEST_F(Peer, AgreesOnTheExamplesOfLinuxCnc) {
  std::vector<fs::path> paths;
  for (const char* folder :
       {"/usr/share/linuxcnc/ncfiles", "/usr/share/doc/linuxcnc/examples/sample-configs"}) {
    ASSERT_TRUE(fs::exists(folder)) << folder << " is not there; it comes with linuxcnc-uspace";
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".ngc" && entry.is_regular_file() &&
          fs::file_size(entry.path()) < 3'000'000)
        paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  int compared = 0;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    const ProgramFile program =
        plain(path.filename().string(), std::string(std::istreambuf_iterator<char>(in), {}));
    if (!deviation_of(program.name).empty()) continue;
    ++compared;
    if (const auto what = compare_rest(program, own(program)).difference)
      ADD_FAILURE() << path << " differs: " << *what;
  }
  EXPECT_GT(compared, 250);
}

TEST(Shrinking, KeepsTheLinesThatMatter) {
  const auto differs = [](const std::string& text) {
    return text.find("b\n") != std::string::npos && text.find("e\n") != std::string::npos;
  };
  EXPECT_EQ(shrink("a\nb\nc\nd\ne\nf\n", differs, 100), "b\ne\n");
}

TEST(Differences, AreFoundInNamesNumbersAndText) {
  const auto trace = [](std::initializer_list<const char*> calls) {
    Trace t;
    for (const char* call : calls) t.calls.push_back({call, ""});
    return t;
  };
  const Trace a = trace({"ON_RESET()", "DWELL(0.5000)", "PROGRAM_END()"});
  EXPECT_FALSE(difference(a, trace({"ON_RESET()", "DWELL(0.5001)", "PROGRAM_END()"})));
  EXPECT_TRUE(difference(a, trace({"ON_RESET()", "DWELL(0.5010)", "PROGRAM_END()"})));
  EXPECT_TRUE(difference(a, trace({"ON_RESET()", "FLOOD_ON()", "PROGRAM_END()"})));
  EXPECT_TRUE(difference(a, trace({"ON_RESET()", "PROGRAM_END()"})));
  EXPECT_TRUE(difference(trace({"ON_RESET()", "MESSAGE(\"1\")"}),
                         trace({"ON_RESET()", "MESSAGE(\"1.0\")"})));
  Trace refused = a;
  refused.error = true;
  EXPECT_TRUE(difference(a, refused));
}

}  // namespace
}  // namespace aircut::test
