// Programs that provoke a kind of finding: tests/data/findings/KIND.ngc raises KIND at the line
// that says (here), KIND.clean.ngc just does not, KIND.edge.ngc is at the limit itself: raised
// where it says (here), else not. (Where there is none, the clean one is at the limit.) A program
// with a NAME.setup.toml beside it runs with that instead of the set-up in the table. Kinds that
// only a wrong plan can raise (velocity_limit …, branch_flip) are provoked in tests/sim.
#include "cli/program.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

constexpr const char* test_tools = "-t tests/data/findings/tools.toml";

struct Sample {
  const char* name;  ///< of the programs
  const char* machine;
  const char* setup = nullptr;
  const char* more = "";
  const char* check = "limits,cut";
  const char* kind = nullptr;  ///< null: as the name
};

const Sample samples[] = {
    {"gouge_live", "mill3", "part"},
    {"gouge", "mill3", "part"},
    {"excess", "mill3", "part"},
    {"wrong_setup", "mill3", "part"},
    {"engagement_limit", "mill3", "block", test_tools},
    {"loose_piece", "mill3", "block"},
    {"rapid_cut", "mill3", "block", test_tools},
    {"spindle_stopped_cut", "mill3", "block", test_tools},
    {"spindle_direction_cut", "mill3", "block", test_tools},
    {"plunge_not_center_cutting", "mill3", "block", test_tools},
    {"no_tool_cut", "mill3", "high_block"},
    {"air_cut", "mill3", "block", test_tools},
    {"noncutting_contact", "mill3", "block", test_tools, "limits,cut", "collision"},
    {"workholding_cut", "mill3", nullptr, "", "collision", "collision"},
    {"collision", "mill3", nullptr, "", "collision"},
    {"near_miss", "mill3", nullptr, "", "collision"},
    {"self_overlap", "mill3", nullptr, "", "collision"},
    {"tool_change_collision", "mill3", nullptr, "", "collision"},
    {"probe_missed", "mill3", "block", test_tools},
    {"probe_contact", "mill3", "block", test_tools},
    {"overtravel", "mill3"},
    {"overtravel_margin", "mill3"},
    {"unreachable", "ox-glide-crossed"},
    {"singular", "ox-glide-crossed"},
    {"axis_unwind", "mill5-ac"},
    {"feed_not_reached", "mill3"},
    {"sync_limit", "mill3"},
    {"tool_unknown", "mill3"},
    {"not_executed", "mill3"},
};

/// Line with a mark; 0 without one.
int marked_line(const fs::path& file) {
  std::ifstream in(file);
  int n = 0;
  for (std::string line; std::getline(in, line);)
    if (++n; line.find("(here)") != std::string::npos) return n;
  return 0;
}

class Findings : public Program, public ::testing::WithParamInterface<Sample> {
 protected:
  static fs::path beside(const std::string& file) {
    return fs::path(AIRCUT_SOURCE_DIR) / "tests/data/findings" / file;
  }
  static std::string kind() { return GetParam().kind ? GetParam().kind : GetParam().name; }
  Outcome run(const std::string& name) {
    const Sample& sample = GetParam();
    std::string command = "run tests/data/findings/" + name + ".ngc -m " + sample.machine + " " +
                          sample.more + " --check " + sample.check + " --format gcc";
    if (fs::exists(beside(name + ".setup.toml")))
      command += " --setup tests/data/findings/" + name + ".setup.toml";
    else if (sample.setup)
      command += " --setup tests/data/findings/" + std::string(sample.setup) + ".setup.toml";
    return aircut(command);
  }
  /// Whether a row of the kind stands at the line; at any line for 0.
  bool told(const Outcome& outcome, const std::string& name, int line) const {
    const std::string place = name + ".ngc:" + std::to_string(line) + ":";
    std::istringstream rows(outcome.out);
    for (std::string row; std::getline(rows, row);)
      if (row.find("[" + kind() + "]") != std::string::npos &&
          (line == 0 || row.find(place) != std::string::npos))
        return true;
    return false;
  }
};

TEST_P(Findings, AreRaisedByTheirProgramAndNotByTheOneThatJustDoesNot) {
  const std::string name = GetParam().name;
  const Outcome raised = run(name);
  EXPECT_TRUE(told(raised, name, marked_line(beside(name + ".ngc")))) << raised.out << raised.err;
  const Outcome clean = run(name + ".clean");
  EXPECT_FALSE(told(clean, name, 0)) << clean.out;
  EXPECT_EQ(clean.code, 0) << clean.out << clean.err;
  EXPECT_EQ(aircut("explain " + name).code, 0);
}

TEST_P(Findings, AreRaisedOrNotRightAtTheLimit) {
  const std::string name = std::string(GetParam().name) + ".edge";
  if (!fs::exists(beside(name + ".ngc"))) return;  // the clean one is at the limit
  const Outcome outcome = run(name);
  const int line = marked_line(beside(name + ".ngc"));
  EXPECT_EQ(told(outcome, name, line), line > 0) << outcome.out << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(All, Findings, ::testing::ValuesIn(samples),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace aircut
