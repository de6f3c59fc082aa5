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
  EXPECT_EQ(r.count(Kind::overtravel), 0);
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

TEST_F(Travel, TellsAJointThatComesNearItsLimit) {
  const RunResult r = run("G21 G90 G61\nG0 X199.25\nG0 Y10\nG0 X199.5\nG0 X0\nM2\n");
  const Finding& f = r.only(Kind::overtravel_margin);
  EXPECT_EQ(f.severity, Severity::info);
  EXPECT_EQ(f.span.line, 2u);  // it is in the margin until line 5
  EXPECT_EQ(f.joint, "X");
  EXPECT_NEAR(*f.value, 199.25, 1e-4);
  EXPECT_EQ(*f.limit, 200);
  EXPECT_NEAR(f.u_first, 199 / 199.25, 1e-4);
  EXPECT_EQ(r.verdict, Verdict::pass);
  // Again after it was away from there; and a bulge of an arc is enough.
  EXPECT_EQ(run("G21 G90 G61\nG0 X199.25\nG0 X0\nG0 X199.25\nM2\n").count(Kind::overtravel_margin),
            2);
  EXPECT_EQ(run("G21 G90 G61 G17\nG0 X169.5 Y-30\nG3 X169.5 Y30 J30 F3000\nM2\n")
                .only(Kind::overtravel_margin)
                .span.line,
            3u);
}

TEST_F(Travel, LeavesAMillimetreAtTheLimitAlone) {
  EXPECT_TRUE(run("G21 G90 G61\nG0 X199\nG0 X-199\nM2\n").findings.empty());
  EXPECT_EQ(run("G21 G90 G61\nG0 X199.001\nM2\n").count(Kind::overtravel_margin), 1);
  // Beyond the limit it is overtravel.
  EXPECT_EQ(run("G21 G90 G61\nG0 X200.5\nM2\n").count(Kind::overtravel_margin), 0);
}

TEST_F(Travel, KeepsTheHundredNearestPlacesAndCountsTheRest) {
  const RunResult r =
      run("G21 G90 G61\n#1=0\nO1 while [#1 LT 150]\nG0 X[199.2 + #1/1000]\nG0 X190\n#1=[#1+1]\n"
          "O1 endwhile\nM2\n");
  EXPECT_EQ(r.count(Kind::overtravel_margin), 100);
  EXPECT_NEAR(*r.findings.front().value, 199.25, 1e-4);
  EXPECT_NE(r.findings.back().message.find("50 more places"), std::string::npos);
  EXPECT_EQ(r.verdict, Verdict::pass);
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
  EXPECT_EQ(
      run("G21 G90 G61 G17\nG0 X170 Y-30\nG3 X170 Y30 J30 F3000\nM2\n").count(Kind::overtravel), 0);
}

TEST_F(Travel, ReportsEveryJointAndEveryBlockOfOneEpisode) {
  const RunResult r = run("G21 G90 G61\nG0 X210 Y210\nG0 X220\nM2\n");
  EXPECT_EQ(r.count(Kind::overtravel), 4);
}

// ---- feed_not_reached: 5000 mm/s² on each axis; half of F6000 takes 0.25 mm to reach ----

TEST_F(Travel, TellsABlockThatStaysUnderHalfOfItsFeed) {
  // From rest to rest 0.25 mm at each end are under 50 mm/s.
  const RunResult r = run("G21 G90 G61\nG1 X4 F6000\nM2\n");
  const Finding& f = r.only(Kind::feed_not_reached);
  EXPECT_EQ(f.severity, Severity::info);
  EXPECT_EQ(f.span.line, 2u);
  EXPECT_NEAR(*f.value, 100 * 0.5 / 4, 0.2);  // per cent of the way
  EXPECT_EQ(*f.limit, 10);
  EXPECT_EQ(r.verdict, Verdict::pass);
}

TEST_F(Travel, LeavesABlockAloneThatIsSlowOverLessThanATenth) {
  EXPECT_TRUE(run("G21 G90 G61\nG1 X5.2 F6000\nM2\n").findings.empty());
  EXPECT_EQ(run("G21 G90 G61\nG1 X4.8 F6000\nM2\n").count(Kind::feed_not_reached), 1);
}

TEST_F(Travel, ListsTheTwentyBlocksThatLoseMostTime) {
  const RunResult r =
      run("G21 G90 G61\nF6000\n#1=0\nO1 while [#1 LT 50]\nG91 G1 X[0.1 + #1/100]\nY0.1\n#1=[#1+1]\n"
          "O1 endwhile\nM2\n");
  EXPECT_EQ(r.count(Kind::feed_not_reached), 20);
  bool told = false;
  for (const Finding& f : r.findings) told |= f.message.find("80 more blocks") != std::string::npos;
  EXPECT_TRUE(told);
}

// ---- axis_unwind ----

class Unwind : public ::testing::Test {
 protected:
  RunResult run(const std::string& text) {
    Diagnostics out;
    const auto colon = machine_.find(':');
    const std::string name = machine_.substr(0, colon);
    const auto machine = machine::read_machine(
        name[0] == '/' ? name : AIRCUT_SOURCE_DIR "/machines/" + name, sources_, out,
        colon == std::string::npos ? "" : machine_.substr(colon + 1));
    if (!machine) {
      ADD_FAILURE() << machine.error().message;
      return {};
    }
    return run_program("G21 G90 G61\n" + text + "M2\n", *machine, {}, sources_,
                       {.collision = false, .cut = false});
  }
  SourceMap sources_;
  std::string machine_ = "mill5-ac";
};

TEST_F(Unwind, TellsARotaryJointThatGoesTheLongWay) {
  const RunResult r = run("G0 C200\n");
  const Finding& f = r.only(Kind::axis_unwind);
  EXPECT_EQ(f.severity, Severity::warning);
  EXPECT_EQ(f.span.line, 2u);
  EXPECT_EQ(f.joint, "C");
  EXPECT_NEAR(*f.value, 200, 1e-6);
  EXPECT_EQ(*f.limit, 180);
  EXPECT_EQ(r.verdict, Verdict::pass);
}

TEST_F(Unwind, LeavesHalfATurnAlone) {
  EXPECT_EQ(run("G0 C180\nG0 C0\n").count(Kind::axis_unwind), 0);
  EXPECT_EQ(run("G0 C180.01\n").count(Kind::axis_unwind), 1);
}

TEST_F(Unwind, LeavesAWayAloneThatTurnsTheToolElsewhere) {
  // With the table tilted by 30° the tool points 59° away after 200° of C.
  EXPECT_EQ(run("G0 A-30\nG0 C200\n").count(Kind::axis_unwind), 0);
  // Tilted by 5° it is nearly the same direction.
  EXPECT_EQ(run("G0 A-5\nG0 C200\n").only(Kind::axis_unwind).span.line, 3u);
}

TEST_F(Unwind, LeavesATurntableAloneThatDrawsAnArc) {
  // Without tool centre point control the tip goes round over the work.
  machine_ = "mill5-ac:joints";
  EXPECT_EQ(run("G0 X30\nG1 C270 F2000\n").count(Kind::axis_unwind), 0);
  EXPECT_EQ(run("G0 X30 A-5\nG1 C200 F2000\n").count(Kind::axis_unwind), 1);
}

TEST_F(Unwind, CountsTheTurnsOfAJointThatHasAnEnd) {
  // C of a copy of the machine ends after five turns.
  namespace fs = std::filesystem;
  const BoxMachine place;  // for its folder
  const fs::path copy = fs::path(place.folder()) / "mill";
  fs::copy(AIRCUT_SOURCE_DIR "/machines/mill5-ac", copy, fs::copy_options::recursive);
  std::stringstream text;
  text << std::ifstream(copy / "machine.toml").rdbuf();
  std::string toml = text.str();
  const std::string c = "vmax = 180.0";
  ASSERT_NE(toml.find(c), std::string::npos);
  toml.replace(toml.find(c), c.size(), c + "\nmin = -1800.0\nmax = 1800.0");
  std::ofstream(copy / "machine.toml") << toml;
  machine_ = copy.string();
  const std::string turns = "G0 C150\nG0 C300\nG0 C450\nG0 C600\nG0 C720\n";
  EXPECT_EQ(run(turns).count(Kind::axis_unwind), 0);
  const RunResult r = run(turns + "G0 C730\nG0 C740\n");
  EXPECT_EQ(r.only(Kind::axis_unwind).span.line, 7u);
  // A turntable without an end may turn for ever.
  machine_ = "mill5-ac";
  EXPECT_EQ(run(turns + "G0 C730\n").count(Kind::axis_unwind), 0);
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
