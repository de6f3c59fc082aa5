// What a machine says of its tool change: where it is, and the sub that carries it out.
#include <nlohmann/json.hpp>

#include "program.h"

namespace aircut {
namespace {

class ToolChange : public Program {
 protected:
  // mill3 with more keys in [toolchange].
  void machine_with(const std::string& keys) {
    std::filesystem::copy(AIRCUT_SOURCE_DIR "/machines/mill3", path("mill"),
                          std::filesystem::copy_options::recursive);
    std::string text = text_of(path("mill/machine.toml"));
    const std::string table = "[toolchange]\n";
    text.insert(text.find(table) + table.size(), keys);
    put("mill/machine.toml", text);
    put("main.ngc", "G21 G90 G61\nT1 M6\nM2\n");
  }
  nlohmann::json run() {
    const Outcome outcome = aircut("run " + path("main.ngc") + " -m " + path("mill") + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(ToolChange, GoesToThePositionOfTheMachine) {
  machine_with("position = [15, 25, -30]\n");
  const nlohmann::json extents = run()["extents"];
  EXPECT_NEAR(extents["X"]["high"].get<double>(), 15, 0.02) << extents;
  EXPECT_NEAR(extents["Y"]["high"].get<double>(), 25, 0.02) << extents;
  EXPECT_NEAR(extents["Z"]["low"].get<double>(), -30, 0.02) << extents;
}

TEST_F(ToolChange, CallsTheSubOfTheMachine) {
  machine_with("program = \"subs/change.ngc\"\n");
  std::filesystem::create_directory(path("mill/subs"));
  put("mill/subs/change.ngc", "o<change> sub\nG53 G0 X15\nM6\nG53 G0 Y25\no<change> endsub\nM2\n");
  const nlohmann::json result = run();
  EXPECT_NEAR(result["extents"]["X"]["high"].get<double>(), 15, 0.02);
  EXPECT_NEAR(result["extents"]["Y"]["high"].get<double>(), 25, 0.02);
  EXPECT_NEAR(result["timing"]["tool_change_s"].get<double>(), 6, 1e-9) << result["timing"];
}

TEST_F(ToolChange, NamesASubThatThereIsNot) {
  machine_with("program = \"subs/none.ngc\"\n");
  const Outcome outcome = aircut("run " + path("main.ngc") + " -m " + path("mill"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(outcome.says("none.ngc")) << outcome.err;
}

}  // namespace
}  // namespace aircut
