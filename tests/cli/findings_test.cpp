// Programs that provoke a kind of finding: tests/data/findings/KIND.ngc raises KIND at the line
// that says (here), KIND.clean.ngc just does not.
#include "cli/program.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

struct Sample {
  const char* kind;
  const char* machine;
  const char* setup;  ///< null: none
  const char* more;
};

const Sample samples[] = {
    {"gouge_live", "mill3", "part", ""},
    {"gouge", "mill3", "part", ""},
    {"excess", "mill3", "part", ""},
    {"wrong_setup", "mill3", "wrong_setup", ""},
    {"engagement_limit", "mill3", "block", "-t tests/data/findings/tools.toml"},
    {"loose_piece", "mill3", "block", ""},
    {"probe_missed", "mill3", "block", "-t tests/data/findings/tools.toml"},
    {"probe_contact", "mill3", "block", "-t tests/data/findings/tools.toml"},
    {"overtravel_margin", "mill3", nullptr, ""},
    {"axis_unwind", "mill5-ac", nullptr, ""},
    {"feed_not_reached", "mill3", nullptr, ""},
};

class Findings : public Program, public ::testing::WithParamInterface<Sample> {
 protected:
  Outcome run(const std::string& name, const char* setup) {
    const Sample& sample = GetParam();
    std::string command = "run tests/data/findings/" + name + " -m " + sample.machine + " " +
                          sample.more + " --check limits,cut --format gcc";
    if (setup) command += " --setup tests/data/findings/" + std::string(setup) + ".setup.toml";
    return aircut(command);
  }
};

/// The line with a mark; 0 without one.
int marked_line(const fs::path& file) {
  std::ifstream in(file);
  int n = 0;
  for (std::string line; std::getline(in, line);)
    if (++n; line.find("(here)") != std::string::npos) return n;
  return 0;
}

TEST_P(Findings, AreRaisedByTheirProgramAndNotByTheOneThatJustDoesNot) {
  const std::string kind = GetParam().kind;
  const std::string mark = "[" + kind + "]";
  const Outcome raised = run(kind + ".ngc", GetParam().setup);
  ASSERT_TRUE(raised.says(mark)) << raised.out << raised.err;
  const int line =
      marked_line(fs::path(AIRCUT_SOURCE_DIR) / "tests/data/findings" / (kind + ".ngc"));
  if (line > 0) {
    bool at_line = false;
    std::istringstream rows(raised.out);
    for (std::string row; std::getline(rows, row);)
      at_line |= row.find(kind + ".ngc:" + std::to_string(line) + ":") != std::string::npos &&
                 row.find(mark) != std::string::npos;
    EXPECT_TRUE(at_line) << raised.out;
  }
  const bool other_part = kind == "wrong_setup";
  const Outcome clean = run(kind + ".clean.ngc", other_part ? "part" : GetParam().setup);
  EXPECT_FALSE(clean.says(mark)) << clean.out;
  EXPECT_EQ(clean.code, 0) << clean.out << clean.err;
  EXPECT_TRUE(aircut("explain " + kind).code == 0);
}

using Probing = Program;

TEST_F(Probing, OfADescribedBlockIsKnownToAllChecks) {
  const std::string job = " -m mill3 -t tests/data/findings/tools.toml";
  const std::string block = " --setup tests/data/findings/block.setup.toml";
  const std::string clean = "tests/data/findings/probe_missed.clean.ngc";
  const Outcome met = aircut("run " + clean + job + block);
  EXPECT_EQ(met.code, 0) << met.out << met.err;
  // Where nothing moves nobody knows.
  EXPECT_EQ(aircut("check " + clean + job).code, 2);
}

INSTANTIATE_TEST_SUITE_P(All, Findings, ::testing::ValuesIn(samples),
                         [](const auto& one) { return std::string(one.param.kind); });

}  // namespace
}  // namespace aircut
