#include <gtest/gtest.h>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

TEST(Run, StopsMovingAtTheFirstRefusedBlockAndReadsOn) {
  BoxMachine box;
  const RunResult r = run_program("G21 G90 G61\nG0 X10\nG1 X20 Q5 F100\nG0 X150\nG0 X1o\nM2\n",
                                  box.machine(), {}, box.sources());
  EXPECT_EQ(r.diagnostics.errors(), 2u);
  EXPECT_EQ(r.count(Kind::collision), 0);  // the rapid through the plate was never reached
  EXPECT_EQ(r.verdict, Verdict::fail);
  ASSERT_EQ(r.summary.unchecked.size(), 1u);
  EXPECT_NE(r.summary.unchecked[0].find("test.ngc:3"), std::string::npos);
  EXPECT_NEAR(r.summary.joints[0].high, 10, 0.011);
}

TEST(Run, IsUnknownWhenUserCodesWereNotRun) {
  BoxMachine box;
  const RunResult r =
      run_program("G21 G90 G61\nM110\nG0 X10\nM2\n", box.machine(), {}, box.sources());
  EXPECT_EQ(r.count(Kind::not_executed), 1);
  EXPECT_EQ(r.verdict, Verdict::unknown);
}

TEST(Run, TakesTheMachinesWordForUserCodes) {
  BoxMachine box("[mcodes]\nM110 = { kind = \"ignore\" }\n");
  const RunResult r =
      run_program("G21 G90 G61\nM110\nG0 X10\nM2\n", box.machine(), {}, box.sources());
  EXPECT_TRUE(r.findings.empty());
  EXPECT_EQ(r.verdict, Verdict::pass);
}

// `high` of X and what Y Z reached, after a tool change on this machine.
sim::Summary summary_of_change(BoxMachine& box, const machine::Machine& machine) {
  tool::ToolTable tools;
  tools.tools.emplace_back().number = 1;
  const RunResult r =
      run_program("G21 G90 G61\nT1 M6\nM2\n", std::make_shared<machine::Machine>(machine), tools,
                  box.sources());
  for (const Diagnostic& d : r.diagnostics.list()) ADD_FAILURE() << d.message;
  return r.summary;
}

TEST(Run, GoesToTheMachinesPositionForAToolChange) {
  BoxMachine box("[toolchange]\ntime = 2\nposition = [10.0, -20.0, 30.0]\n");
  const sim::Summary summary = summary_of_change(box, *box.machine());
  EXPECT_NEAR(summary.joints[0].high, 10, 1e-2);
  EXPECT_NEAR(summary.joints[1].low, -20, 1e-2);
  EXPECT_NEAR(summary.joints[2].high, 30, 1e-2);
  EXPECT_EQ(summary.tool_change_time, 2);
}

TEST(Run, FailsWhereThePlannerCouldNotKeepALimit) {
  BoxMachine box;
  const auto machine = box.machine();
  Simulator simulator(machine, {}, machine->home(), {});
  simulator.start();
  plan::Segment segment;
  segment.limit_problem = "no time law was found here";
  simulator.step(segment);
  const auto result = simulator.finish();
  ASSERT_EQ(result.findings.size(), 1u);
  EXPECT_EQ(result.findings[0].kind, Kind::dynamics_limit);
  EXPECT_EQ(judge(result.findings, result.summary, {}, Severity::error), Verdict::fail);
}

TEST(Run, IsUnknownWhenAnInputIsRead) {
  BoxMachine box;
  const RunResult r =
      run_program("G21 G90 G61\nM66 P0 L0\nG0 X#5399\nM2\n", box.machine(), {}, box.sources());
  EXPECT_TRUE(r.only(Kind::not_checked).makes_unknown);
  EXPECT_EQ(r.verdict, Verdict::unknown);
}

TEST(Run, DoesNotMindAnInputThatNobodyLooksAt) {
  BoxMachine box;
  const char* immediate = "G21 G90 G61\nM66 P0 L0\nG0 X10\nM2\n";
  EXPECT_EQ(run_program(immediate, box.machine(), {}, box.sources()).verdict, Verdict::pass);
  const char* waits = "G21 G90 G61\nM66 P0 L3 Q1\nG0 X10\nM2\n";
  EXPECT_EQ(run_program(waits, box.machine(), {}, box.sources()).verdict, Verdict::unknown);
}

TEST(Run, IsUnknownWhenThereIsNothingToCollide) {
  BoxMachine box(
      "[collision]\nignore = [{ bodies = [\"post\", \"plate\"], reason = \"all there is\" }]\n");
  const RunResult r = run_program("G21 G90\nG0 X10\nM2\n", box.machine(), {}, box.sources());
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_NE(r.summary.unchecked.at(0).find("no two bodies"), std::string::npos);
}

TEST(Run, SurvivesCoordinatesBeyondAllReason) {
  BoxMachine box;
  for (const char* x : {"1000000000000", "-100000000000", "1000000000000000000000000000000"}) {
    const RunResult r = run_program("G21 G90\nG0 X" + std::string(x) + "\nM2\n", box.machine(), {},
                                    box.sources(), {}, 1e300);
    EXPECT_NE(r.verdict, Verdict::pass) << x;
    const RunResult limited =
        run_program("G21 G90\nG0 X" + std::string(x) + "\nM2\n", box.machine(), {}, box.sources());
    EXPECT_NE(limited.verdict, Verdict::pass) << x;
  }
}

TEST(Run, FailsForAToolThatIsNotInTheTable) {
  BoxMachine box;
  const RunResult r = run_program("G21 G90 G61\nT7 M6\nM2\n", box.machine(), {}, box.sources());
  EXPECT_EQ(r.verdict, Verdict::fail);
}

TEST(Run, IsUnknownWhenSimulatedTimeRunsOut) {
  BoxMachine box;
  const RunResult r =
      run_program("G21 G90 G61\nG1 X10 F1\nG1 X20\nM2\n", box.machine(), {}, box.sources(), {}, 60);
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_NE(r.summary.unchecked.at(0).find("simulated time"), std::string::npos);
}

TEST(Judge, NeverPassesWhatWasNotChecked) {
  const Diagnostics clean;
  EXPECT_EQ(judge({}, {}, clean, Severity::error), Verdict::pass);
  Summary open;
  open.unchecked = {"something"};
  EXPECT_EQ(judge({}, open, clean, Severity::error), Verdict::unknown);
  Summary many;
  many.findings_dropped = 1;
  EXPECT_EQ(judge({}, many, clean, Severity::error), Verdict::unknown);

  Finding warning;
  warning.kind = Kind::near_miss;
  warning.severity = Severity::warning;
  EXPECT_EQ(judge({warning}, {}, clean, Severity::error), Verdict::pass);
  EXPECT_EQ(judge({warning}, {}, clean, Severity::warning), Verdict::fail);
  warning.unresolved = true;
  EXPECT_EQ(judge({warning}, {}, clean, Severity::error), Verdict::unknown);

  Diagnostics refused;
  refused.error("arc_error", {}, "…");
  EXPECT_EQ(judge({}, {}, refused, Severity::error), Verdict::fail);
  EXPECT_EQ(judge({}, {}, refused, std::nullopt), Verdict::pass);  // a doubt, not a refusal
  Summary stopped;
  stopped.program_refused = true;
  EXPECT_EQ(judge({}, stopped, refused, std::nullopt), Verdict::unknown);
}

TEST(Findings, AreSortedNumberedAndTiedIntoEpisodes) {
  Findings findings(3);
  std::uint32_t block = 0;
  const auto add = [&](Kind kind, double t0, double t1) {
    Finding f;
    f.block = ++block;
    f.kind = kind;
    f.t_first = t0;
    f.t_end = t1;
    findings.add(f);
  };
  add(Kind::near_miss, 5, 6);
  add(Kind::collision, 2, 3);
  add(Kind::collision, 1, 2);
  add(Kind::collision, 9, 9);
  EXPECT_EQ(findings.dropped(), 1u);
  const auto list = findings.finish();
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].t_first, 1);
  EXPECT_EQ(list[0].id, 1);
  EXPECT_EQ(list[0].episode, list[1].episode);
  EXPECT_NE(list[1].episode, list[2].episode);
}

TEST(Kinds, EachHasANameASeverityAndALongText) {
  for (int i = 0; i <= static_cast<int>(Kind::wait_deadlock); ++i) {
    const std::string name(to_string(static_cast<Kind>(i)));
    bool found = false;
    for (const KindText& row : finding_kinds()) found = found || name == row.kind;
    EXPECT_TRUE(found) << name;
  }
}

}  // namespace
}  // namespace aircut::sim
