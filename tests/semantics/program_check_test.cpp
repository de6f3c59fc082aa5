// Each check: a program that raises it, one that just does not, one at the boundary.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "interp/interp.h"
#include "semantics/semantics.h"

namespace aircut::semantics {
namespace {

tool::Tool make_tool(int number, double length, double max_rpm) {
  tool::Tool tool;
  tool.number = number;
  tool.offset[Axis::z] = length;
  tool.diameter = 2.0 * number;
  tool.max_rpm = max_rpm;
  return tool;
}

struct Result {
  std::vector<std::string> found;  ///< "kind line:column word"
  std::vector<std::string> messages;
  std::vector<Severity> severities;
  std::vector<std::string> unchecked;
};

class Doubts : public ::testing::Test {
 protected:
  Doubts() {
    tools_.tools = {make_tool(1, 50, 6000), make_tool(2, 80, 0), make_tool(3, 50, 0),
                    make_tool(4, 0, 0)};
    machine_.spindle_.min_rpm = 100;
    machine_.spindle_.max_rpm = 12000;
  }

  Result run(const std::string& text) {
    SourceMap sources;
    Diagnostics diagnostics;
    interp::Options options;
    options.ini = {};
    options.dialect = dialect_;
    interp::Interpreter interpreter(sources.add("a.ngc", text), tools_, parameters_, options, {},
                                    diagnostics);
    const auto before = interpreter.parameters();
    const bool offset_rows = dialect_ != interp::Dialect::linuxcnc;
    ProgramCheck check({tools_, with_machine_ ? &machine_ : nullptr, simulated_, offset_rows},
                       diagnostics, diagnostics);
    while (const auto command = interpreter.next()) {
      check.see(*command);
      if (const auto* probe = std::get_if<canon::Probe>(&command->action))
        interpreter.resume({.tip = probe->end, .tripped = false});
    }
    check.finish({interpreter.statistics().ended, before.values, interpreter.parameters().values,
                  interpreter.statistics().input_read});
    Result out;
    out.unchecked = check.unchecked();
    for (const Diagnostic& d : diagnostics.list()) {
      out.found.push_back(d.kind + " " + std::to_string(d.span.line) + ":" +
                          std::to_string(d.span.column()) + " " + std::string(d.span.covered()));
      out.messages.push_back(d.message);
      out.severities.push_back(d.severity);
    }
    return out;
  }
  std::vector<std::string> found(const std::string& text) { return run(text).found; }

  using List = std::vector<std::string>;
  tool::ToolTable tools_;
  interp::ParameterFile parameters_;
  machine::Machine machine_;
  bool with_machine_ = false, simulated_ = false;
  interp::Dialect dialect_ = interp::Dialect::linuxcnc;
};

const std::string head = "G21 G17 G90\nT1 M6\nM3 S1000 F100\n";

// ---- length

TEST_F(Doubts, TellsWhenHNamesAnotherToolThanTheOneInTheSpindle) {
  const Result r = run(head + "G43 (not H1) H2\nG0 Z10\nG1 X5\nM5\nM2\n");
  EXPECT_EQ(r.found, List{"wrong_offset 4:14 H2"});
  EXPECT_EQ(r.severities[0], Severity::error);
  EXPECT_EQ(r.messages[0],
            "G43 takes the length of T2, but T1 is in the spindle: its tip runs 30.000 mm higher "
            "than programmed");
}

TEST_F(Doubts, AcceptsTheToolsOwnH) {
  EXPECT_EQ(found(head + "G43 H1\nG0 Z10\nG1 X5\nM2\n"), List{});
  EXPECT_EQ(found(head + "G43\nG0 Z10\nG1 X5\nM2\n"), List{});
  EXPECT_EQ(found(head + "G43 H0\nG0 Z10\nG1 X5\nM2\n"), List{});
}

TEST_F(Doubts, OnlyWarnsWhenTheOtherToolIsEquallyLong) {
  const Result r = run(head + "G43 H3\nG0 Z10\nG1 X5\nM2\n");
  EXPECT_EQ(r.found, List{"wrong_offset 4:5 H3"});
  EXPECT_EQ(r.severities[0], Severity::warning);
}

TEST_F(Doubts, AcceptsALengthThatIsGivenJustBeforeItsTool) {
  EXPECT_EQ(found("G21\nT1 M6\nM3 S500 F100\nM5\nG43 H2\nT2 M6\nM3\nG0 Z9\nG1 X5\nM2\n"), List{});
}

TEST_F(Doubts, TellsAboutALengthForAnEmptySpindle) {
  EXPECT_EQ(found("G21\nT0 M6\nG43 H2\nG0 Z9\nM2\n"), List{"wrong_offset 3:5 H2"});
  // Which tool is in the spindle before the first change, nobody has said.
  EXPECT_EQ(found("G21\nG43 H2\nG0 Z9\nM2\n"), List{});
}

TEST_F(Doubts, TellsWhenTheLengthOfTheToolBeforeIsStillInForceAtTheFirstCut) {
  const std::string change = head + "G43 H1\nG0 Z10\nG1 X5\nM5\nT2 M6\nM3\n";
  const Result r = run(change + "G0 Z9\nG1 X9\nG1 X5\nM2\n");
  EXPECT_EQ(r.found, List{"wrong_offset 11:1 G1 X9"});
  EXPECT_EQ(r.messages[0],
            "T2 moves at the feed with the length of T1, which is in force since "
            "line 4");
  // Rapids on the way to the new length are as usual.
  EXPECT_EQ(found(change + "G0 X0 Y0\nG43 H2 Z9\nG1 X9\nM2\n"), List{});
  EXPECT_EQ(found(change + "G0 X0 Y0\nM2\n"), List{});
}

TEST_F(Doubts, TellsWhenNoLengthIsInForceAtTheFirstCut) {
  EXPECT_EQ(found(head + "G0 Z9\nG1 X9\nG1 X5\nM2\n"), List{"length_offset_missing 5:1 G1 X9"});
  EXPECT_EQ(found(head + "G43 H1\nG49\nG0 Z9\nG2 X9 I4.5\nM2\n"),
            List{"length_offset_missing 7:1 G2 X9 I4.5"});
  EXPECT_EQ(found(head + "G0 Z9\nM2\n"), List{});
  EXPECT_EQ(found(head + "G43.1 Z3\nG1 X9\nM2\n"), List{});
  // Tool 4 has no length in the table: it is touched off.
  EXPECT_EQ(found("G21\nT4 M6\nM3 S500 F100\nG1 X9\nM2\n"), List{});
}

TEST_F(Doubts, WarnsWhenDNamesAnotherTool) {
  EXPECT_EQ(found(head + "G43 H1\nG41 D2\nG1 X10 Y0\nG1 X20\nG40\nG1 X30 Y9\nM2\n"),
            List{"wrong_offset 5:5 D2"});
  EXPECT_EQ(found(head + "G43 H1\nG41 D1\nG1 X10 Y0\nG1 X20\nG40\nG1 X30 Y9\nM2\n"), List{});
}

// ---- spindle

TEST_F(Doubts, WarnsOfAMoveAtTheFeedWithTheSpindleStopped) {
  const Result r = run("G21 F100\nG0 X1\nG1 X2\nG1 X3\nM3 S500\nG1 X4\nM5\nG1 X5\nM2\n");
  EXPECT_EQ(r.found, (List{"spindle_stopped_cut 3:1 G1 X2", "spindle_stopped_cut 8:1 G1 X5"}));
  EXPECT_EQ(r.severities[0], Severity::warning);
  EXPECT_EQ(found("G21 F100\nM4 S500\nG1 X2\nM5\nG0 X5\nM2\n"), List{});
  EXPECT_EQ(found("G21 F100\nS500\nG1 M3 X2\nM2\n"), List{});  // M3 acts before the move
}

TEST_F(Doubts, LetsAProbeMoveWithTheSpindleStopped) {
  EXPECT_EQ(run("G21 F100\nG1 X2\nG38.3 Z-5\nG1 X3\nM2\n").found,
            List{"not_checked 3:1 G38.3 Z-5"});
}

TEST_F(Doubts, WarnsOfM3WithoutASpeed) {
  EXPECT_EQ(found("G21 F100\nM3\nG1 X2\nG1 X3\nM2\n"), List{"speed_missing 2:1 M3"});
  EXPECT_EQ(found("G21 F100\nM3\nG0 X2\nS200\nG1 X3\nM2\n"), List{});
}

TEST_F(Doubts, RefusesFeedPerRevolutionWithAStoppedSpindle) {
  const Result r = run("G21 S500\nG95 F0.2\nG1 X2\nG1 X3\nM2\n");
  EXPECT_EQ(r.found, List{"feed_missing 3:1 G1 X2"});
  EXPECT_EQ(r.severities[0], Severity::error);
  EXPECT_EQ(found("G21 S500\nG95 F0.2\nM3\nG1 X2\nM2\n"), List{});
}

TEST_F(Doubts, TellsASpeedAboveTheToolsMaximum) {
  const Result r = run("G21\nT1 M6\nG43 H1\nM3 S6001 F100\nG1 X2\nM2\n");
  EXPECT_EQ(r.found, List{"spindle_speed_limit 4:4 S6001"});
  EXPECT_EQ(r.severities[0], Severity::error);
  EXPECT_EQ(found("G21\nT1 M6\nG43 H1\nM3 S6000 F100\nG1 X2\nM2\n"), List{});
  // S for the next tool stands before its M6; and a speed that never turns harms nobody.
  EXPECT_EQ(found("G21\nT1 M6\nG43 H1\nM3 S500 F100\nG1 X2\nM5\nS9000 T2 M6\nG43 H2\nM3\nG1 X3\n"
                  "M2\n"),
            List{});
  EXPECT_EQ(found("G21\nT1 M6\nS9000\nG0 X5\nM2\n"), List{});
}

TEST_F(Doubts, WarnsOfASpeedOutsideOfTheMachinesRange) {
  with_machine_ = true;
  const std::string tool = "G21 F100\nT2 M6\nG43 H2\n";
  const Result high = run(tool + "M3 S12001\nG1 X2\nM2\n");
  EXPECT_EQ(high.found, List{"spindle_speed_limit 4:4 S12001"});
  EXPECT_EQ(high.severities[0], Severity::warning);
  EXPECT_EQ(found(tool + "M3 S99\nG1 X2\nM2\n"), List{"spindle_speed_limit 4:4 S99"});
  EXPECT_EQ(found(tool + "M3 S12000\nG1 X2\nS100\nG1 X5\nM2\n"), List{});
  EXPECT_EQ(found(tool + "G96 D20000 S50\nM3\nG1 X2\nM2\n"),
            List{"spindle_speed_limit 4:5 D20000"});
  EXPECT_EQ(found(tool + "G96 D3000 S50\nM3\nG1 X2\nG97 S13000\nG1 X5\nM2\n"),
            List{"spindle_speed_limit 7:5 S13000"});
}

TEST_F(Doubts, NotesAToolChangeWithTheSpindleOn) {
  const std::string start = "G21\nT1 M6\nG43 H1\nM3 S500 F100\nG1 X2\n";
  const Result r = run(start + "T2 M6\nM2\n");
  EXPECT_EQ(r.found, List{"tool_change_spindle_on 6:4 M6"});
  EXPECT_EQ(r.severities[0], Severity::info);
  EXPECT_EQ(found(start + "M5\nT2 M6\nM2\n"), List{});
}

// ---- radius compensation and cycles

TEST_F(Doubts, WarnsOfARapidThatBeginsOrEndsRadiusCompensation) {
  const std::string start = "G21 F100 M3 S500\nG41.1 D4\n";
  EXPECT_EQ(found(start + "G0 X20 Y0\nG1 X40\nG40\nG1 X60 Y9\nM2\n"),
            List{"comp_rapid 3:1 G0 X20 Y0"});
  EXPECT_EQ(found(start + "G1 X20 Y0\nG1 X40\nG40\nG0 Z60\nM2\n"), List{"comp_rapid 6:1 G0 Z60"});
  EXPECT_EQ(found(start + "G1 X20 Y0\nG1 X40\nG40\nG1 X60 Y9\nG0 Z60\nM2\n"), List{});
  // A rapid between is a matter of taste: the tool keeps its distance.
  EXPECT_EQ(found(start + "G1 X20 Y0\nG0 X40\nG40\nG1 X60 Y9\nM2\n"), List{});
}

TEST_F(Doubts, WarnsOfAPlaneOrUnitThatChangesWithinAGroupOfCycles) {
  const std::string start = "G21 G17 F100 M3 S500\nG0 Z10\nG81 X1 Y1 Z-5 R2\n";
  EXPECT_EQ(found(start + "G20\nX1 Y1\nG80\nM2\n"), List{"cycle_modal_change 5:1 X1 Y1"});
  EXPECT_EQ(found(start + "G18\nG81 X1 Z1 Y-5 R2\nG80\nM2\n"),
            List{"cycle_modal_change 5:1 G81 X1 Z1 Y-5 R2"});
  EXPECT_EQ(found(start + "G20\nG80\nG0 X1\nM2\n"), List{});
  EXPECT_EQ(found(start + "G80 G18\nG81 X1 Z1 Y-5 R2\nG80\nM2\n"), List{});
  EXPECT_EQ(found(start + "G20\nX1 Y1 Z-.2 R.1\nX2\nG80\nM2\n"), List{});
}

// ---- what the next program inherits

TEST_F(Doubts, WarnsOfAnOffsetThatIsLeftOn) {
  const Result r = run("G21\nG0 X10\nG92 X0 Z3\nG0 X5\nM2\n");
  EXPECT_EQ(r.found, List{"offset_left_on 3:1 G92"});
  EXPECT_NE(r.messages[0].find("(X 10  Z -3)"), std::string::npos) << r.messages[0];
  EXPECT_EQ(found("G21\nG52 X3\nG0 X5\nM2\n"), List{"offset_left_on 2:1 G52"});
  EXPECT_EQ(found("G21\nG92 X3\nG0 X5\nG92.1\nM2\n"), List{});
  EXPECT_EQ(found("G21\nG92 X3\nG0 X5\nG92.2\nM2\n"), List{});
  EXPECT_EQ(found("%\nG21\nG52 X3\nG0 X5\n%\n"), List{"offset_left_on 3:1 G52"});
}

TEST_F(Doubts, IsSilentAboutAnOffsetThatWasThereBefore) {
  parameters_.values = {{5210, 1}, {5211, 7}, {5230, 30}};
  EXPECT_EQ(found("G21\nG0 X10\nM2\n"), List{});
  EXPECT_EQ(found("G21\nG92.2\nG0 X10\nG92.3\nM2\n"), List{});
}

TEST_F(Doubts, WarnsOfARotationThatIsLeftOn) {
  EXPECT_EQ(found("G21\nG10 L2 P1 R30\nG0 X5\nM2\n"), List{"offset_left_on 2:1 G10 L2 P1 R30"});
  EXPECT_EQ(found("G21\nG10 L2 P2 R30\nG0 X5\nM2\n").size(), 1u);  // of a system not in force
  EXPECT_EQ(found("G21\nG10 L2 P1 R30\nG0 X5\nG10 L2 P1 R0\nM2\n"), List{});
}

// ---- what nobody here can know

TEST_F(Doubts, SaysThatUserCodesAndInputsAreNotKnown) {
  const Result r = run("G21\nM110 P1\n#1=#5399\nM66 P2 L3 Q5\nM66 P2 L0\nM2\n");
  EXPECT_EQ(r.found, (List{"not_executed 2:1 M110", "wait_code 4:1 M66",
                           "not_checked 4:1 M66 P2 L3 Q5", "not_checked 5:1 M66 P2 L0"}));
  EXPECT_EQ(r.unchecked.size(), 3u);
  EXPECT_EQ(found("G21\nM66 P2 L0\nM2\n"), List{}) << "nobody looks at #5399";
  simulated_ = true;  // then the simulation tells it
  EXPECT_EQ(found("G21\nM110 P1\nM66 P2 L3 Q5\nM2\n"), List{"wait_code 3:1 M66"});
  simulated_ = false;
  with_machine_ = true;
  machine_.user_codes_[110] = {machine::UserCodeKind::ignore, 0};
  EXPECT_EQ(found("G21\nM110 P1\nM2\n"), List{});
}

// ---- after a refused block

TEST_F(Doubts, TellsNothingThatFollowsFromARefusedBlockAlone) {
  EXPECT_EQ(found("G21 F100\nM3 S500 ?\nG1 X5\nM2\n"), List{"bad_character 2:9 ?"});
  EXPECT_EQ(found(head + "G43 H77\nG1 X5\nM2\n"), List{"tool_unknown 4:5 H77"});
  EXPECT_EQ(found("G21 F100\no<start_up> call\nG1 X5\nM2\n"),
            List{"sub_missing 2:1 o<start_up> call"});
}

TEST_F(Doubts, GoesOnAfterARefusedBlockThatHasNothingToDoWithIt) {
  EXPECT_EQ(found("G21 F100\nG2 X5 I1\nG1 X5\nM2\n"),
            (List{"arc_error 2:1 G2", "spindle_stopped_cut 3:1 G1 X5"}));
}

TEST_F(Doubts, TellsAPlaceOnceHoweverOftenItIsPassed) {
  EXPECT_EQ(found("G21 F100\no1 repeat [5]\n  M3 S500\n  G1 X1\n  M5\n  G1 X2\no1 endrepeat\nM2\n"),
            List{"spindle_stopped_cut 6:3 G1 X2"});
}

TEST_F(Doubts, FindsTheWordBehindExpressionsAndComments) {
  EXPECT_EQ(found("G21\nT1 M6\n#<_h> = 2\nG43 (H1) H[1 + ABS[-1]] (; H3)\nG0 Z5\nM2\n"),
            List{"wrong_offset 4:10 H[1 + ABS[-1]]"});
  EXPECT_EQ(found("G21\nT1 M6\n#<_h> = 2\nG43 H #<_h> ; H1\nG0 Z5\nM2\n"),
            List{"wrong_offset 4:5 H #<_h>"});
}

TEST_F(Doubts, HasATextForEveryKind) {
  for (const KindText& kind : semantic_kinds()) {
    EXPECT_TRUE(is_semantic(kind.kind)) << kind.kind;
    EXPECT_GT(std::string(kind.title).size(), 10u) << kind.kind;
    EXPECT_GT(std::string(kind.text).size(), 100u) << kind.kind;
  }
  EXPECT_TRUE(is_semantic("wrong_offset"));
  EXPECT_FALSE(is_semantic("arc_error"));
}

// On Fanuc-like controls H and D are rows of offsets.
TEST_F(Doubts, JudgeOffsetRowsByWhatIsInThem) {
  dialect_ = interp::Dialect::fanuc;
  const auto at = [&](const std::string& h) {
    return run("G21 S1000\nT1 M6\nM3\nG43 H" + h + " Z5.\nG1 Z-1. F100.\nM30\n");
  };
  EXPECT_EQ(at("1").found, List{});
  EXPECT_EQ(at("3").found, List{});  // as long as T1
  const Result other = at("2");
  EXPECT_EQ(other.found, List{"wrong_offset 4:5 H2"});
  EXPECT_EQ(other.severities, std::vector<Severity>{Severity::warning});
  EXPECT_NE(other.messages[0].find("30.000 mm higher"), std::string::npos) << other.messages[0];
  // A row that no tool is named after is meant.
  EXPECT_EQ(found("G21 S1000\nG10 L11 P12 R70.\nT1 M6\nM3\nG43 H12 Z5.\nG1 Z-1. F100.\nM30\n"),
            List{});
  // The one of the tool before is not.
  EXPECT_EQ(found("G21 S1000\nT2 M6\nM3\nG43 H2 Z5.\nM5\nT1 M6\nM3\nG1 Z-1. F100.\nM30\n"),
            List{"wrong_offset 8:1 G1 Z-1. F100."});
  EXPECT_EQ(found("G21 S1000\nT1 M6\nM3\nG43 H1 Z5.\nG41 D2 G1 X5. F100.\nX20.\nG40 X40.\nM30\n"),
            List{"wrong_offset 5:5 D2"});
  EXPECT_EQ(found("G21 S1000\nG10 L12 P20 R0.9\nT1 M6\nM3\nG43 H1 Z5.\nG41 D20 G1 X5. "
                  "F100.\nX20.\nG40 X40.\nM30\n"),
            List{});
}

TEST_F(Doubts, TellFramesThatAreLeftOn) {
  dialect_ = interp::Dialect::fanuc;
  EXPECT_EQ(found("G21\nG68 X0 Y0 R30.\nT1 M6\nG69\nM30\n"), List{"frame_left_on 3:4 M6"});
  EXPECT_EQ(found("G21\nG16\nM30\n"), List{"frame_left_on 3:1 M30"});
  EXPECT_EQ(found("G21\nG51 X0 Y0 Z0 P2.\nG50\nG51.1 X0\nG50.1 X0\nM30\n"), List{});
}

}  // namespace
}  // namespace aircut::semantics
