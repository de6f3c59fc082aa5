#include <gtest/gtest.h>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

class Collision : public ::testing::Test {
 protected:
  RunResult run(const std::string& text, const CheckOptions& options = {}) {
    return run_program(text, box_.machine(), {}, box_.sources(), options);
  }
  BoxMachine box_;
};

TEST_F(Collision, FindsAThinPlateCrossedByARapid) {
  const RunResult r = run("G21 G90 G61\nG0 X150\nM2\n");
  const Finding& f = r.only(Kind::collision);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_EQ(f.span.line, 2u);
  EXPECT_EQ(f.body_a, "post");
  EXPECT_EQ(f.body_b, "plate");
  // The post's right face is at X + 5: contact from X 45 to X 55.02.
  EXPECT_NEAR(f.joints_first[0], 45, 0.01);
  EXPECT_NEAR(f.u_first, 45.0 / 150, 1e-3);
  EXPECT_NEAR(f.u_end, 55.02 / 150, 1e-3);
  ASSERT_TRUE(f.depth.has_value());
  EXPECT_GT(*f.depth, 0.01);
  EXPECT_LE(*f.depth, 5.03);
}

TEST_F(Collision, GoesOnFindingContactsInLaterBlocks) {
  const RunResult r = run("G21 G90 G61\nG0 X150\nG0 X0\nM2\n");
  for (const Finding& f : r.findings)
    EXPECT_EQ(f.kind, Kind::collision) << f.message << " at " << f.t_first << " … " << f.t_end;
  ASSERT_EQ(r.findings.size(), 2u);  // and no near misses beside them
  EXPECT_EQ(r.count(Kind::collision), 2);
  EXPECT_EQ(r.findings.at(0).span.line, 2u);
  EXPECT_EQ(r.findings.at(1).span.line, 3u);
  EXPECT_NE(r.findings.at(0).episode, r.findings.at(1).episode);
}

TEST_F(Collision, TiesOneContactThatLastsOverBlocksIntoAnEpisode) {
  const RunResult r = run("G21 G90 G61\nG1 F6000 X47\nG1 Y20\nG1 X0\nM2\n");
  ASSERT_EQ(r.count(Kind::collision), 3);
  EXPECT_EQ(r.findings.at(0).episode, r.findings.at(1).episode);
  EXPECT_EQ(r.findings.at(1).episode, r.findings.at(2).episode);
}

TEST_F(Collision, GivesOneRowForABlockThatComesInSeveralPieces) {
  // G64 rounds the corner between the two blocks, inside the plate.
  const RunResult r = run("G21 G90 G64 P2\nG1 F6000 X50\nG1 Y20\nG0 X0\nM2\n");
  EXPECT_EQ(r.count(Kind::collision), 3);
}

TEST_F(Collision, TellsANearMissWithItsDistance) {
  // At Z 51 the post's lower face passes 1 mm above the plate.
  const RunResult r = run("G21 G90 G61\nG0 Z51\nG0 X150\nM2\n");
  EXPECT_EQ(r.count(Kind::collision), 0);
  const Finding& f = r.only(Kind::near_miss);
  EXPECT_EQ(f.span.line, 3u);
  EXPECT_NEAR(*f.value, 1, 0.006);
  EXPECT_LE(*f.value, 1 + 1e-9);
  EXPECT_EQ(r.verdict, Verdict::pass);
}

TEST_F(Collision, TellsBodiesThatStandNearThoughNothingMoves) {
  // The post's right face is at X 5, the plate at X 50.
  const RunResult r = run("G21 G90\nG4 P1\nM2\n", {.near = 46});
  const Finding& f = r.only(Kind::near_miss);
  EXPECT_NEAR(*f.value, 45, 1e-9);
  EXPECT_EQ(f.body_a, "post");
  EXPECT_EQ(f.body_b, "plate");
  EXPECT_NEAR(f.points.at(0).x(), 5, 1e-9);
  EXPECT_NE(f.message.find("stands 45.000 mm from"), std::string::npos) << f.message;
  EXPECT_TRUE(run("G21 G90\nG4 P1\nM2\n", {.near = 45}).findings.empty());
  // Where it moves after that, the motion tells it, and nothing is told twice.
  const RunResult moved = run("G21 G90\nG4 P1\nG0 X-0.5\nG4 P1\nM2\n", {.near = 46});
  EXPECT_EQ(moved.only(Kind::near_miss).message.find("stands"), std::string::npos);
}

TEST_F(Collision, SaysNothingBeyondTheMargin) {
  const RunResult r = run("G21 G90 G61\nG0 Z52.1\nG0 X150\nM2\n");
  EXPECT_TRUE(r.findings.empty());
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_EQ(r.summary.collision.clear, 1);
}

TEST_F(Collision, LeavesNearMissesOutWhenTheMarginIsZero) {
  const RunResult r = run("G21 G90 G61\nG0 Z51\nG0 X150\nM2\n", {.near = 0});
  EXPECT_TRUE(r.findings.empty());
}

TEST_F(Collision, NeverCallsAGapBelowTheResolutionClear) {
  const RunResult r = run("G21 G90 G61\nG0 Z50.001\nG0 X150\nM2\n");
  EXPECT_EQ(r.count(Kind::collision), 0);
  ASSERT_GE(r.count(Kind::near_miss), 1);
  EXPECT_TRUE(r.findings.at(0).unresolved);
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_LT(r.summary.collision.clear, 1);
}

TEST_F(Collision, SharesOfTheMotionAddUpToAllOfIt) {
  const RunResult r = run("G21 G90 G61\nG0 X150\nG0 Z50.001\nG0 X0\nM2\n");
  const auto& c = r.summary.collision;
  EXPECT_NEAR(c.clear + c.hit + c.unresolved, 1, 1e-12);
  EXPECT_GT(c.hit, 0);
}

TEST(CollisionModel, NamesAnOverlapAtTheStartOnceAndGoesOn) {
  BoxMachine box("[[body]]\nname = \"wall\"\nlink = \"bed\"\nmesh = \"meshes/post.stl\"\n");
  const RunResult r =
      run_program("G21 G90 G61\nG0 X20\nG0 X150\nM2\n", box.machine(), {}, box.sources());
  EXPECT_EQ(r.only(Kind::self_overlap).body_b, "wall");
  EXPECT_EQ(r.only(Kind::collision).body_b, "plate");
}

TEST(CollisionModel, LeavesOutPairsExcludedByNameAndListsThem) {
  BoxMachine box(
      "[collision]\nignore = [{ bodies = [\"post\", \"plate\"], reason = \"a curtain\" }]\n");
  const RunResult r = run_program("G21 G90 G61\nG0 X150\nM2\n", box.machine(), {}, box.sources());
  EXPECT_EQ(r.count(Kind::collision), 0);
  ASSERT_EQ(r.summary.collision.exclusions.size(), 1u);
  EXPECT_NE(r.summary.collision.exclusions[0].find("a curtain"), std::string::npos);
}

TEST(CollisionModel, SeesABodyThatEndsUpWhollyInsideAnother) {
  BoxMachine box("[[body]]\nname = \"block\"\nlink = \"bed\"\nmesh = \"meshes/block.stl\"\n");
  const RunResult r = run_program("G21 G90 G61\nG0 Y-100\nM2\n", box.machine(), {}, box.sources());
  const Finding& f = r.only(Kind::collision);
  EXPECT_EQ(f.body_b, "block");
  EXPECT_NEAR(f.joints_first[1], -75, 0.01);
  EXPECT_NEAR(f.u_end, 1, 1e-9);
}

tool::ToolTable one_tool(double length) {
  tool::Tool tool;
  tool.number = 1;
  tool.name = "pin";
  tool.gauge_length = length;
  tool.offset[Axis::z] = length;
  tool.pieces = {{tool::PieceRole::cutter, "cutter", {{0, 0}, {2, 0}, {2, length}, {0, length}}}};
  return {{tool}};
}

TEST_F(Collision, ChecksTheToolThatWasChangedIn) {
  const std::string text = "G21 G90 G61\nG0 Z60\nT1 M6\nG0 X150\nM2\n";
  EXPECT_EQ(run_program(text, box_.machine(), one_tool(5), box_.sources()).count(Kind::collision),
            0);
  const RunResult r = run_program(text, box_.machine(), one_tool(15), box_.sources());
  const Finding& f = r.only(Kind::collision);
  EXPECT_EQ(f.body_a, "T1/cutter");
  EXPECT_EQ(f.pair, "cutter-machine");
  EXPECT_EQ(f.tool, 1);
  // It reaches 5 mm below the plate's upper edge: lifted by that and a little it clears.
  EXPECT_NE(f.remedy.find("5.0"), std::string::npos) << f.remedy;
}

TEST_F(Collision, FindsTheNewToolInsideSomethingAsSoonAsItIsThere) {
  const RunResult r = run_program("G21 G90 G61\nG0 Z55\nG0 X50\nT1 M6\nM2\n", box_.machine(),
                                  one_tool(30), box_.sources());
  EXPECT_EQ(r.only(Kind::tool_change_collision).span.line, 4u);
  EXPECT_EQ(r.verdict, Verdict::fail);
}

TEST_F(Collision, IsUnknownWithAToolThatHasNoGeometry) {
  tool::ToolTable tools = one_tool(10);
  tools.tools[0].pieces.clear();
  const RunResult r =
      run_program("G21 G90 G61\nT1 M6\nG0 X10\nM2\n", box_.machine(), tools, box_.sources());
  EXPECT_TRUE(r.only(Kind::not_checked).makes_unknown);
  EXPECT_EQ(r.verdict, Verdict::unknown);
}

}  // namespace
}  // namespace aircut::sim
