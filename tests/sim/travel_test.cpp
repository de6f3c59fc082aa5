#include <gtest/gtest.h>

#include <cmath>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

class Travel : public ::testing::Test {
 protected:
  RunResult run(const std::string& text) {
    return run_program(text, box_.machine(), {}, box_.sources(), {.collision = false});
  }
  BoxMachine box_;
};

TEST_F(Travel, AllowsAJointToGoRightToItsLimit) {
  const RunResult r = run("G21 G90 G61\nG0 X200 Y-200\nG0 X-200\nM2\n");
  EXPECT_TRUE(r.findings.empty());
  EXPECT_EQ(r.verdict, Verdict::pass);
  ASSERT_EQ(r.summary.joints.size(), 3u);
  EXPECT_NEAR(r.summary.joints[0].high, 200, 0.011);
  EXPECT_NEAR(r.summary.joints[0].low, -200, 0.011);
  EXPECT_NEAR(r.summary.joints[1].low, -200, 0.011);
  EXPECT_EQ(r.summary.joints[2].low, 0);
}

TEST_F(Travel, FindsTheFirstMicrometreBeyondIt) {
  const RunResult r = run("G21 G90 G61\nG0 X200.001\nM2\n");
  const Finding& f = r.only(Kind::overtravel);
  EXPECT_EQ(f.joint, "X");
  EXPECT_NEAR(*f.value, 200.001, 1e-5);
  EXPECT_EQ(*f.limit, 200);
  EXPECT_EQ(r.verdict, Verdict::fail);
}

TEST_F(Travel, FindsABulgeOfAnArcWhoseEndsAreInside) {
  // Half circle from (190, -30) to (190, 30) about (190, 0): bulges to X 220.
  const RunResult r = run("G21 G90 G61 G17\nG0 X190 Y-30\nG3 X190 Y30 J30 F3000\nM2\n");
  const Finding& f = r.only(Kind::overtravel);
  EXPECT_EQ(f.span.line, 3u);
  EXPECT_NEAR(*f.value, 220, 1e-4);
  // Outside where 190 + 30 cos a > 200: |a| < acos(1/3), seen from -90° to 90°.
  const double a = std::acos(1.0 / 3) / M_PI;
  EXPECT_NEAR(f.u_first, 0.5 - a, 1e-4);
  EXPECT_NEAR(f.u_end, 0.5 + a, 1e-4);
}

TEST_F(Travel, LeavesAnArcAloneThatJustStaysInside) {
  EXPECT_TRUE(run("G21 G90 G61 G17\nG0 X170 Y-30\nG3 X170 Y30 J30 F3000\nM2\n").findings.empty());
}

TEST_F(Travel, ReportsEveryJointAndEveryBlockOfOneEpisode) {
  const RunResult r = run("G21 G90 G61\nG0 X210 Y210\nG0 X220\nM2\n");
  EXPECT_EQ(r.count(Kind::overtravel), 4);
}

TEST(Reach, EndsTheRunAtThePointThatCantBeReached) {
  SourceMap sources;
  Diagnostics out;
  const auto machine =
      machine::read_machine(AIRCUT_SOURCE_DIR "/machines/ox-glide-crossed", sources, out);
  ASSERT_TRUE(machine) << machine.error().message;
  // The crossed form reaches down to z = d - l2 = -358.
  const RunResult r = run_program("G21 G90 G61\nG1 F1000 Z-340\nG1 Z-365\nG1 Z-300\nM2\n", *machine,
                                  {}, sources, {.collision = false});
  const Finding& f = r.only(Kind::unreachable);
  EXPECT_EQ(f.span.line, 3u);
  EXPECT_NEAR(f.u_first, 18.0 / 25, 1e-4);
  EXPECT_EQ(r.verdict, Verdict::fail);
  ASSERT_EQ(r.summary.unchecked.size(), 1u);
  EXPECT_NE(r.summary.unchecked[0].find("test.ngc:3"), std::string::npos);
}

}  // namespace
}  // namespace aircut::sim
