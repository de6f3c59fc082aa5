// Probing against the model. The stock is a block of 60 x 40 x 20 mm about X0 Y0 whose upper face
// is at Z -80 of the machine; the probe has a ball of 4 mm whose lowest point is the tip.
#include <gtest/gtest.h>

#include <cmath>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

constexpr double accuracy = 0.006;  // mm: the ball is drawn up to 0.005 larger

tool::ToolTable tools() {
  tool::Tool probe;
  probe.number = 1;
  probe.name = "touch probe";
  probe.gauge_length = probe.offset[Axis::z] = 60;
  Profile ball;
  for (int i = 0; i <= 64; ++i) {
    const double angle = M_PI / 2 * i / 64;
    ball.push_back({2 * std::sin(angle), 2 - 2 * std::cos(angle)});
  }
  ball.push_back({2, 4});
  probe.pieces = {{tool::PieceRole::cutter, "probe", ball},
                  {tool::PieceRole::shank, "shank", {{1, 4}, {1, 40}}},
                  {tool::PieceRole::holder, "holder", {{15, 40}, {15, 60}}}};
  tool::Tool mill = probe;
  mill.number = 2;
  mill.pieces[0] = {tool::PieceRole::cutter, "cutter", {{0, 0}, {5, 0}, {5, 20}}};
  mill.pieces[1] = {tool::PieceRole::shank, "shank", {{5, 20}, {5, 40}}};
  return {{probe, mill}};
}

// Ends of the probing moves as the program sees them, through messages.
class Probing : public ::testing::Test, public Observer {
 protected:
  RunResult run(const std::string& text, const std::string& start = "T1 M6 G43 H1\n",
                bool stock = true) {
    messages_.clear();
    auto machine = std::make_shared<machine::Machine>(*box_.machine());
    for (const int j : machine->driven_) machine->tree_[static_cast<std::size_t>(j)].jmax = jmax_;
    machine::Setup setup;
    if (stock) {
      machine::SetupStock block;
      block.raw.size = Vec3(60, 40, 20);
      block.raw.pitch = 0.25;
      block.place = Vec3(0, 0, -100);
      setup.stock = block;
    }
    Diagnostics out;
    const auto placed = machine::apply_setup(*machine, setup, box_.sources(), out);
    EXPECT_TRUE(placed);
    return run_program("G21 G90 G61 G17\n" + start + "F300\n" + text + "M2\n", *placed, tools(),
                       box_.sources(), {}, 360'000, this);
  }
  void on_step(const Step& step) override {
    if (const auto* message = std::get_if<canon::Message>(&step.segment.command.action))
      messages_.push_back(message->text);
    if (step.segment.kind == plan::MotionKind::probe && step.segment.duration() > 0) {
      rest_ = step.motion.tip_at(step.motion.t1());
      trip_ = step.segment.trip;
    }
  }
  double said(std::size_t i) const { return i < messages_.size() ? std::stod(messages_[i]) : NAN; }

  BoxMachine box_;
  double jmax_ = std::numeric_limits<double>::infinity();
  std::vector<std::string> messages_;
  AxisValues rest_;
  std::optional<double> trip_;
};

TEST_F(Probing, TellsTheProgramWhereAFaceIs) {
  const RunResult r =
      run("G0 X10 Y5 Z-70\nG38.2 Z-90\n(DEBUG,#5063)\n(DEBUG,#5061)\n(DEBUG,#5070)\n(DEBUG,#<_z>)\n"
          "G0 Z-70\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  for (const Finding& f : r.findings) ADD_FAILURE() << f.message;
  EXPECT_NEAR(said(0), -80, accuracy);
  EXPECT_EQ(said(1), 10);
  EXPECT_EQ(said(2), 1);
  // Braking from 5 mm/s with 5000 mm/s² takes 0.0025 mm.
  ASSERT_TRUE(trip_);
  EXPECT_NEAR(rest_[Axis::z], -70 - *trip_ - 0.0025, 1e-9);
  EXPECT_NEAR(said(3), rest_[Axis::z], 1e-4);
}

TEST_F(Probing, KnowsTheBallsRadiusAtAnEdge) {
  // The middle of the ball is 1 mm above and 5 mm beside the upper edge at X -30: it touches when
  // it is sqrt(3) beside it.
  run("G0 X-40 Y0 Z-81\nG38.2 X-20\n(DEBUG,#5061)\n");
  EXPECT_NEAR(said(0), -30 - std::sqrt(3.0), accuracy);
}

TEST_F(Probing, SeesWhatHasBeenCut) {
  const RunResult r = run(
      "T2 M6 G43 H2\nS1000 M3\nG0 X-50 Y0\nG0 Z-85\nG1 X40\nG1 X-50\nG0 Z-20\nM5\nT1 M6 G43 H1\n"
      "G0 X0 Z-70\nG38.2 Z-90\n(DEBUG,#5063)\nG0 Z-70\n",
      "");
  EXPECT_NEAR(said(0), -85, accuracy);
  EXPECT_EQ(r.verdict, Verdict::pass);
  for (const Finding& f : r.findings) EXPECT_NE(f.severity, Severity::error) << f.message;
}

TEST_F(Probing, TakesAMissForTheErrorThatItIsOnTheControl) {
  const RunResult r = run("G0 Z-70\nG38.2 Z-79\nG0 X10\n");
  EXPECT_EQ(r.only(Kind::probe_missed).span.line, 5u);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_NEAR(r.summary.joints[0].high, 0, 0.011);  // it went no farther
  const RunResult mild = run("G0 Z-70\nG38.3 Z-79\n(DEBUG,#5070)\n(DEBUG,#5063)\n");
  EXPECT_EQ(mild.count(Kind::probe_missed), 0);
  EXPECT_EQ(mild.verdict, Verdict::pass);
  EXPECT_EQ(said(0), 0);
  EXPECT_EQ(said(1), -79);
}

TEST_F(Probing, FindsWhereTheProbeComesOff) {
  const RunResult r =
      run("F3000\nG0 X10 Z-70\nG38.2 Z-90\nF60\nG38.4 Z-70\n(DEBUG,#5063)\n(DEBUG,#5070)\n");
  EXPECT_NEAR(said(0), -80, accuracy);
  EXPECT_EQ(said(1), 1);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_LT(*trip_, 0.3);
  // Nothing is touched where it begins.
  EXPECT_EQ(run("G0 Z-70\nG38.4 Z-60\n").only(Kind::probe_missed).span.line, 5u);
}

TEST_F(Probing, RefusesToBeginInContact) {
  const RunResult r = run("G0 Z-70\nG38.2 Z-90\nG38.2 Z-91\n");
  EXPECT_EQ(r.only(Kind::probe_missed).span.line, 6u);
}

TEST_F(Probing, TellsOfAProbeThatTouchesOtherwise) {
  const RunResult r = run("G0 Z-79\nG1 Z-81\n");
  EXPECT_EQ(r.only(Kind::probe_contact).span.line, 5u);
  EXPECT_EQ(r.verdict, Verdict::fail);
  // Coming off is none, going on through the block is.
  EXPECT_EQ(run("G0 Z-70\nG38.2 Z-90\nG0 Z-70\n").count(Kind::probe_contact), 0);
  EXPECT_EQ(run("G0 Z-70\nG38.2 Z-90\nG0 Z-85\n").only(Kind::probe_contact).span.line, 6u);
}

TEST_F(Probing, TouchesOtherBodies) {
  // The plate at X 50, up to Z 50; the probe's ball is 2 mm.
  const RunResult r =
      run("G0 X20 Z20\nG38.2 X60\n(DEBUG,#5061)\nG0 X20\n", "T1 M6 G43 H1\n", false);
  EXPECT_NEAR(said(0), 48, accuracy);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_EQ(
      run("G0 X20 Z20\nG38.2 X60\nG0 X52\n", "T1 M6 G43 H1\n", false).count(Kind::probe_contact),
      1);
  EXPECT_EQ(run("G0 X20 Z20\nG0 X60\n", "T1 M6 G43 H1\n", false).count(Kind::probe_contact), 1);
}

TEST_F(Probing, IsUnknownWithoutWorkOrTool) {
  EXPECT_EQ(run("G38.2 Z-20\n", "T1 M6 G43 H1\n", false).verdict, Verdict::unknown);
  EXPECT_TRUE(run("G38.2 Z-20\n", "").only(Kind::not_checked).makes_unknown);
}

TEST_F(Probing, GivesTheSameWhereJerkIsLimited) {
  const std::string text = "F600\nG0 X10 Y5 Z-70\nG38.2 Z-90\n(DEBUG,#5063)\n";
  run(text);
  const double plain = said(0);
  jmax_ = 20'000;
  run(text);
  EXPECT_EQ(said(0), plain);
  // From 10 mm/s: the time of braking is 2 sqrt(v / j), the acceleration never reaches its limit.
  EXPECT_NEAR(rest_[Axis::z], -70 - *trip_ - 10 * std::sqrt(10 / jmax_), 1e-9);
}

}  // namespace
}  // namespace aircut::sim
