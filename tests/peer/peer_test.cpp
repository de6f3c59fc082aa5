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
#include <map>
#include <sstream>

#include "peer/generator.h"
#include "peer/reference.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

const std::string programs_folder = AIRCUT_SOURCE_DIR "/tests/interp_programs/programs";
const std::string sub_folder = programs_folder + "/subs";

/// A difference without its numbers: `call own: DWELL reference: DWELL`.
std::string kind_of(const std::string& difference) {
  if (!difference.starts_with("call ")) return difference.substr(0, difference.find(':'));
  std::string kind;
  bool in_name = true;
  std::istringstream in(difference);
  for (std::string line; std::getline(in, line);) {
    if (line.find("own:") == std::string::npos && line.find("reference:") == std::string::npos)
      continue;
    for (const char c : line) {
      if (c == '(') in_name = false;
      if (in_name) kind += c;
    }
    in_name = true;
  }
  return kind;
}

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
    folder_ = fs::temp_directory_path() / ("aircut_peer_" + std::to_string(::getpid()));
    reference_.emplace(folder_.string(), sub_folder);
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::optional<std::string> compare(const ProgramFile& program) const {
    ProgramFile bounded = program;
    // A loop that never ends is cut off on both sides.
    bounded.options.limits.max_blocks = 2'000'000;
    bounded.options.limits.max_idle_blocks = 1'000'000;
    return difference(own_trace(bounded, sub_folder), reference_->run(bounded));
  }

  /// Reports a difference with the smallest program that still shows one.
  void report(const ProgramFile& program, const std::string& what) const {
    // The same kind of difference, so that a shorter program doesn't drift to another one.
    const auto differs = [&](const std::string& text) {
      ProgramFile fewer = program;
      fewer.text = text;
      const auto found = compare(fewer);
      return found && kind_of(*found) == kind_of(what);
    };
    ProgramFile small = program;
    small.text = shrink(program.text, differs, number_from("AIRCUT_PEER_SHRINK", 150));
    ADD_FAILURE() << program.name << " differs: " << what << "\n  smallest program:\n"
                  << small.text << "  gives: " << compare(small).value_or("no difference");
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
      std::uint32_t number = 0;
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
  int differing = 0, with_errors = 0;
  for (int i = 0; i < count && differing < number_from("AIRCUT_PEER_REPORTS", 10); ++i) {
    const auto seed = static_cast<std::uint32_t>(first + i);
    const ProgramFile program = plain("seed " + std::to_string(seed), generate_program(seed));
    with_errors += own_trace(program, sub_folder).error;
    const auto what = compare(program);
    if (!what) continue;
    ++differing;
    report(program, *what);
  }
  // Programs that are all refused at once would compare nothing.
  EXPECT_LT(with_errors, count * 2 / 3 + 1);
}

/// Examples that meet an accepted deviation (docs/peer.md).
std::string deviation_of(const std::string& example) {
  static const std::map<std::string, std::string> deviations = {
      {"lathe_g70_71_demo.ngc", "G70 to G72"},
      {"lathe_g7x_face_boring.ngc", "G70 to G72"},
      {"lathe_g7x_quadrants.ngc", "G70 to G72"},
      {"mmount.ngc", "M6 with G43 in force"},
      {"skeleton.ngc", "M6 with G43 in force"},
      {"offsets.ngc", "M61"},
      {"smartprobe.ngc", "probing"},
  };
  const auto found = deviations.find(example);
  return found == deviations.end() ? std::string() : found->second;
}

TEST_F(Peer, AgreesOnTheExamplesOfLinuxCnc) {
  const fs::path folder = "/usr/share/linuxcnc/ncfiles";
  ASSERT_TRUE(fs::exists(folder)) << folder << " is not there; it comes with linuxcnc-uspace";
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".ngc" && fs::file_size(entry.path()) < 3'000'000)
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  int compared = 0;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    const ProgramFile program =
        plain(path.filename().string(), std::string(std::istreambuf_iterator<char>(in), {}));
    if (!deviation_of(program.name).empty()) continue;
    ++compared;
    if (const auto what = compare(program)) ADD_FAILURE() << program.name << " differs: " << *what;
  }
  EXPECT_GT(compared, 10);
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
