// Turning on a lathe of boxes: X carries Z, no Y. The bar has a radius of 20 and is 60 mm long; it
// stands from Z -160 to Z -100 of the machine on the spindle's axis, X 0.
#include <gtest/gtest.h>

#include <numbers>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

constexpr double pi = std::numbers::pi;

class Turning : public ::testing::Test {
 protected:
  // T1: a bar of 8 mm, its edge towards the axis; T2: an insert with a nose of 0.4; T3: a drill of
  // 10 mm with a flat end, its shank wider than its flutes.
  static tool::ToolTable tools() {
    const auto revolved = [](int number, double radius, double shank) {
      tool::Tool tool;
      tool.number = number;
      tool.gauge_length = tool.offset[Axis::z] = 60;
      tool.flute_length = 20;
      tool.pieces = {{tool::PieceRole::cutter, "cutter", {{0, 0}, {radius, 0}, {radius, 20}}},
                     {tool::PieceRole::shank, "shank", {{shank, 20}, {shank, 60}}}};
      return tool;
    };
    tool::Tool edge = revolved(1, 4, 3);
    edge.offset[Axis::x] = 4;
    tool::Tool insert;
    insert.number = 2;
    insert.diameter = 0.8;
    insert.orientation = 2;  // the nose is above and to the right of the controlled point
    insert.front_angle = 80 * pi / 180;
    insert.back_angle = 15 * pi / 180;
    insert.flute_length = 12;
    insert.offset[Axis::z] = 60;
    return {{edge, insert, revolved(3, 5, 6)}};
  }

  RunResult run(const std::string& text, const std::string& start = "T1 M6 G43 H1\n",
                const std::string& raw = "cylinder", const Profile& part = {}) {
    auto machine = std::make_shared<machine::Machine>(*box_.machine());
    machine->kinematics_ = machine::make_identity({Axis::x, Axis::z});
    // The axis Y of the boxes stays where it is.
    std::erase_if(machine->driven_,
                  [&](int j) { return machine->tree_[static_cast<std::size_t>(j)].name == "Y"; });
    for (machine::Joint& joint : machine->tree_) {
      if (joint.name == "Y") joint.driven = -1;
      if (joint.name == "Y") joint.held = true;
      if (joint.name == "Z") joint.driven = 1;
    }
    machine::Setup setup;
    setup.stock.emplace();
    machine::RawStock& piece = setup.stock->raw;
    piece.shape = raw == "box" ? machine::StockShape::box : machine::StockShape::cylinder;
    piece.size = Vec3(40, 40, 60);
    piece.diameter = 40;
    piece.bore = raw == "tube" ? 18 : 0;
    piece.height = 60;
    piece.pitch = 0.1;
    setup.stock->place = Vec3(raw == "shifted" ? 1 : 0, 0, -160);
    if (!part.empty()) {
      std::ofstream(box_.folder() + "/part.stl", std::ios::binary)
          << stl_bytes(revolve(part, 0.005));
      setup.folder = box_.folder();
      setup.part.emplace();
      setup.part->mesh_path = "part.stl";
    }
    Diagnostics out;
    const auto placed = machine::apply_setup(*machine, setup, box_.sources(), out);
    EXPECT_TRUE(placed);
    return run_program("G21 G90 G61 G18\n" + start + "S1000 M3 F1000\nG0 X30\n" + text + "M2\n",
                       *placed, tools(), box_.sources());
  }
  double left(const RunResult& r) {
    EXPECT_TRUE(r.summary.stock);
    return r.summary.stock ? r.summary.stock->volume : 0;
  }
  BoxMachine box_;
};

TEST_F(Turning, TurnsAStepOfItsExactVolume) {
  const RunResult r = run("G0 Z-95\nG0 X15\nG1 Z-130\nG1 X30\nG0 Z-50\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  for (const Finding& f : r.findings) ADD_FAILURE() << f.message;
  EXPECT_NEAR(r.summary.stock->initial_volume, pi * 400 * 60, 1e-3);
  EXPECT_NEAR(left(r), pi * (225 * 30 + 400 * 30), 1);
}

TEST_F(Turning, ComparesTheResultWithThePart) {
  const Profile shaft = {{0, 0}, {20, 0}, {20, 30}, {15, 30}, {15, 60}, {0, 60}};
  const auto step = [](const std::string& x, const std::string& z) {
    return "G0 Z-95\nG0 X" + x + "\nG1 Z" + z + "\nG1 X30\nG0 Z-50\n";
  };
  const RunResult good = run(step("15", "-130"), "T1 M6 G43 H1\n", "cylinder", shaft);
  EXPECT_EQ(good.verdict, Verdict::pass);
  for (const Finding& f : good.findings) ADD_FAILURE() << f.message;
  ASSERT_TRUE(good.summary.part);
  EXPECT_LT(good.summary.part->gouge, 0.01);
  EXPECT_LT(good.summary.part->excess, 0.01);
  // A tenth too thin, and a millimetre too long a shoulder.
  const RunResult thin = run(step("14.9", "-130"), "T1 M6 G43 H1\n", "cylinder", shaft);
  EXPECT_EQ(thin.verdict, Verdict::fail);
  EXPECT_GE(thin.count(Kind::gouge), 1);
  // The line that went too deep is told, also with what is found in the end.
  const Finding& live = thin.only(Kind::gouge_live);
  EXPECT_EQ(live.span.line, 7u);
  EXPECT_NEAR(*live.depth, 0.1, 0.01);
  EXPECT_EQ(live.body_a, "T1/cutter");
  for (const Finding& f : thin.findings)
    if (f.kind == Kind::gouge) {
      EXPECT_EQ(f.span.line, 7u);
    }
  EXPECT_NEAR(thin.summary.part->gouge, 0.1, 0.01);
  const RunResult lengthy = run(step("15", "-129"), "T1 M6 G43 H1\n", "cylinder", shaft);
  EXPECT_EQ(lengthy.count(Kind::gouge), 0);
  EXPECT_GE(lengthy.count(Kind::excess), 1);
  EXPECT_NEAR(lengthy.summary.part->excess, 1, 0.01);
  EXPECT_EQ(lengthy.verdict, Verdict::pass);
}

TEST_F(Turning, TellsAGougeOfAnInsertOnceAndNotWithinTheTolerance) {
  const Profile shaft = {{0, 0}, {20, 0}, {20, 30}, {15, 30}, {15, 60}, {0, 60}};
  const auto passes = [&](const std::string& x, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += "G0 Z-95\nG0 X" + x + "\nG1 Z-128\nG0 X30\n";
    return run(text + "G0 Z-50\n", "T2 M6 G43 H2\n", "cylinder", shaft);
  };
  EXPECT_EQ(passes("14.985", 1).count(Kind::gouge_live), 0);
  // The second pass takes nothing more.
  EXPECT_EQ(passes("14.9", 2).count(Kind::gouge_live), 1);
}

TEST_F(Turning, TurnsATaper) {
  // From radius 10 at the free end to 20 at the chuck's end, in two cuts of a bar 8 mm wide.
  const RunResult r = run("G0 Z-94\nG0 X14\nG1 X25 Z-160\nG0 Z-94\nG0 X9\nG1 X20 Z-160\nG1 X30\n");
  const double frustum = pi * 60 / 3 * (100 + 200 + 400);
  // The line passes radius 10 at Z -100.
  EXPECT_NEAR(left(r), frustum, 1e-3 * frustum);
  EXPECT_EQ(r.count(Kind::rapid_cut), 0);
}

TEST_F(Turning, FindsARapidThroughTheBar) {
  const RunResult r = run("G0 Z-95\nG0 X15\nG0 Z-130\n");
  const Finding& f = r.only(Kind::rapid_cut);
  EXPECT_EQ(f.span.line, 7u);
  EXPECT_NEAR(f.u_first, 5.0 / 35, 5e-3);
  EXPECT_NEAR(*f.value, pi * (400 - 225) * 30, 10);
  // On the bar's radius it touches and takes nothing.
  EXPECT_EQ(run("G0 Z-95\nG0 X20\nG0 Z-130\n").count(Kind::rapid_cut), 0);
  EXPECT_EQ(run("G0 Z-95\nG0 X19.98\nG0 Z-130\n").count(Kind::rapid_cut), 1);
}

TEST_F(Turning, DoesNotVouchForThreads) {
  const RunResult r = run("G0 Z-95\nG0 X19\nG33 Z-120 K1.5\nG0 X30\nG0 Z-95\n");
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_NE(r.only(Kind::not_checked).message.find("cuts a thread"), std::string::npos);
  EXPECT_EQ(r.count(Kind::rapid_cut), 0);
  // One that stays outside of the bar takes nothing and harms nothing.
  EXPECT_EQ(run("G0 Z-95\nG0 X21\nG33 Z-120 K1.5\nG0 X30\n").verdict, Verdict::pass);
}

TEST_F(Turning, GoesBackThroughWhatWasCut) {
  EXPECT_EQ(run("G0 Z-95\nG0 X15\nG1 Z-130\nG0 Z-95\n").count(Kind::rapid_cut), 0);
}

TEST_F(Turning, NeedsATurningSpindleAndATool) {
  EXPECT_EQ(run("M5\nG0 Z-95\nG0 X15\nG1 Z-130\n").only(Kind::spindle_stopped_cut).span.line, 8u);
  EXPECT_EQ(run("G0 Z-95\nG0 X15\nG1 Z-130\n", "").count(Kind::no_tool_cut), 1);
}

TEST_F(Turning, CutsWithTheNoseOfAnInsert) {
  const RunResult r = run("G0 Z-95\nG0 X18\nG1 Z-130\nG1 X30\n", "T2 M6 G43 H2\n");
  // It cuts, but there is no body of it that could collide.
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_EQ(r.only(Kind::not_checked).body_b, "");
  EXPECT_EQ(r.findings.size(), 1u);
  // Less the fillet at the shoulder.
  const double fillet = 2 * pi * 18 * (1 - pi / 4) * 0.4 * 0.4;
  EXPECT_NEAR(left(r), pi * (400 * 30 + 324 * 30) + fillet, 5);
}

TEST_F(Turning, DrillsAndFindsAShankInTheHole) {
  const RunResult fine = run("G0 X0 Z-95\nG1 Z-118\nG0 Z-90\n", "T3 M6 G43 H3\n");
  EXPECT_EQ(fine.verdict, Verdict::pass);
  EXPECT_NEAR(left(fine), pi * (400 * 60 - 25 * 18), 2);
  // The flutes are 20 mm long: at 25 the shank is 5 mm deep, and a millimetre too wide.
  const RunResult deep = run("G0 X0 Z-95\nG1 Z-125\nG0 Z-90\n", "T3 M6 G43 H3\n");
  ASSERT_EQ(deep.count(Kind::collision), 2);  // and on the way back
  EXPECT_EQ(deep.findings[0].pair, "shank-stock");
  EXPECT_EQ(deep.findings[0].span.line, 6u);
}

TEST_F(Turning, TellsLongFeedMovesInTheAir) {
  EXPECT_EQ(run("G0 Z-95\nG0 X21\nG1 Z-130\n").count(Kind::air_cut), 1);
  EXPECT_EQ(run("G0 Z-95\nG0 X21\nG1 Z-115\n").count(Kind::air_cut), 0);
}

TEST_F(Turning, IsUnknownWithAStockThatIsNotRoundOrNotOnTheAxis) {
  const std::string cut = "G0 Z-95\nG0 X15\nG1 Z-130\n";
  for (const char* raw : {"box", "shifted"})
    EXPECT_EQ(run(cut, "T1 M6 G43 H1\n", raw).verdict, Verdict::unknown) << raw;
}

}  // namespace
}  // namespace aircut::sim
