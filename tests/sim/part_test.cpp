// A run against the design. The block is 60 x 40 x 20 mm, its upper face at Z -80; the part has a
// slot along X, 10 mm wide and 5 mm deep.
#include <gtest/gtest.h>

#include "support/box_machine.h"
#include "support/run_program.h"
#include "support/slot_part.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

class AgainstThePart : public ::testing::Test {
 protected:
  RunResult run(const std::string& text, machine::SetupPart part = {}) {
    std::ofstream(box_.folder() + "/slot.stl", std::ios::binary)
        << stl_bytes(testing::slotted_block(Vec3(60, 40, 20), 10, 5));
    machine::Setup setup;
    setup.folder = box_.folder();
    setup.stock.emplace();
    setup.stock->raw.size = Vec3(60, 40, 20);
    setup.stock->raw.pitch = 0.5;
    setup.stock->place = Vec3(0, 0, -100);
    part.mesh_path = "slot.stl";
    setup.part = part;
    Diagnostics out;
    const auto placed = machine::apply_setup(*box_.machine(), setup, box_.sources(), out);
    EXPECT_TRUE(placed);
    for (const Diagnostic& d : out.list()) ADD_FAILURE() << d.message;
    tool::Tool tool;
    tool.number = 1;
    tool.gauge_length = tool.offset[Axis::z] = 60;
    tool.flute_length = 20;
    tool.pieces = {{tool::PieceRole::cutter, "cutter", {{0, 0}, {5, 0}, {5, 20}}}};
    return run_program(
        "G21 G90 G61 G17\nT1 M6 G43 H1\nS1000 M3 F1000\nG0 X-50 Y0\n" + text + "G0 Z-70\nM2\n",
        *placed, {{tool}}, box_.sources());
  }
  BoxMachine box_;
};

TEST_F(AgainstThePart, PassesWhatIsAsDesigned) {
  const RunResult r = run("G0 Z-83\nG1 X40\nG0 Z-85\nG1 X-50\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  for (const Finding& f : r.findings) ADD_FAILURE() << f.message;
  ASSERT_TRUE(r.summary.part);
  EXPECT_LT(r.summary.part->gouge, 1e-3);
  EXPECT_LT(r.summary.part->excess, 1e-3);
  EXPECT_EQ(r.summary.part->bound, 0.25);
}

TEST_F(AgainstThePart, FindsTheLineThatWentTooDeep) {
  const RunResult r = run("G0 Z-85\nG1 X40\nG0 Z-85.2\nG1 X-50\n");
  EXPECT_EQ(r.verdict, Verdict::fail);
  const Finding& live = r.only(Kind::gouge_live);
  EXPECT_EQ(live.span.line, 8u);
  EXPECT_NEAR(*live.depth, 0.2, 1e-3);
  EXPECT_EQ(live.pair, "cutter-part");
  EXPECT_NEAR(live.u_first, 5.0 / 90, 4e-3);  // its front meets a ray of X 30 after 5 mm
  const Finding& gouge = r.only(Kind::gouge);
  EXPECT_EQ(gouge.span.line, 8u);
  EXPECT_NEAR(*gouge.depth, 0.2, 1e-3);
  EXPECT_NEAR(gouge.points.at(0).z(), -85.2, 1e-3);  // the machine's frame
  EXPECT_EQ(r.summary.part->gouges, 1u);
}

TEST_F(AgainstThePart, FindsTheWrongLengthOffset) {
  // The program asks for the right depth, the tool goes 1 mm deeper.
  const RunResult r = run("G43.1 Z59\nG0 Z-85\nG1 X40\n");
  EXPECT_NEAR(*r.only(Kind::gouge_live).depth, 1, 1e-3);
  EXPECT_EQ(r.only(Kind::gouge).span.line, 7u);
}

TEST_F(AgainstThePart, LetsASpareCutBeAsDeepAsTheTolerance) {
  EXPECT_EQ(run("G0 Z-85.018\nG1 X40\n").count(Kind::gouge_live), 0);
  EXPECT_EQ(run("G0 Z-85.022\nG1 X40\n").count(Kind::gouge_live), 1);
  machine::SetupPart wide;
  wide.part.gouge = 0.1;
  EXPECT_EQ(run("G0 Z-85.09\nG1 X40\n", wide).verdict, Verdict::pass);
}

TEST_F(AgainstThePart, TellsWhatIsLeft) {
  const RunResult r = run("G0 Z-84.8\nG1 X40\n");
  EXPECT_EQ(r.verdict, Verdict::pass);  // a warning
  EXPECT_NEAR(*r.only(Kind::excess).depth, 0.2, 1e-3);
  EXPECT_EQ(run("G0 Z-84.96\nG1 X40\n").count(Kind::excess), 0);
  machine::SetupPart rough;
  rough.part.allowance = 0.2;
  EXPECT_EQ(run("G0 Z-84.8\nG1 X40\n", rough).count(Kind::excess), 0);
}

TEST_F(AgainstThePart, RefusesAPartThatIsNotInTheRawPiece) {
  machine::SetupPart shifted;
  shifted.place = Vec3(0, 2, 0);
  const RunResult r = run("G0 Z-85\nG1 X40\n", shifted);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_NEAR(*r.only(Kind::wrong_setup).depth, 2, 1e-3);
  shifted.place = Vec3(0, 0.02, 0);
  EXPECT_EQ(run("G0 Z-85\nG1 X40\n", shifted).count(Kind::wrong_setup), 0);
}

}  // namespace
}  // namespace aircut::sim
