// The cutter against the stock of that moment. The stock is a block of 60 x 40 x 20 mm about X0 Y0
// whose upper face is at Z -80 of the machine.
#include <gtest/gtest.h>

#include "support/box_machine.h"
#include "support/run_program.h"

namespace aircut::sim {
namespace {

using testing::BoxMachine;
using testing::run_program;
using testing::RunResult;

struct Shape {
  double flutes = 20, shank = 5;  ///< length and radius, mm
  bool center_cutting = true, left_hand = false;
  tool::CuttingLimits limits = {};
};

tool::ToolTable end_mill(const Shape& shape = {}) {
  tool::Tool tool;
  tool.number = 1;
  tool.name = "10 mm end mill";
  tool.gauge_length = tool.offset[Axis::z] = 60;
  tool.flute_length = shape.flutes;
  tool.center_cutting = shape.center_cutting;
  tool.left_hand = shape.left_hand;
  tool.teeth = 2;
  tool.limits = shape.limits;
  tool.pieces = {
      {tool::PieceRole::cutter, "cutter", {{0, 0}, {5, 0}, {5, shape.flutes}}},
      {tool::PieceRole::shank, "shank", {{shape.shank, shape.flutes}, {shape.shank, 40}}},
      {tool::PieceRole::holder, "holder", {{15, 40}, {15, 60}}}};
  return {{tool}};
}

class Cutting : public ::testing::Test {
 protected:
  // A program that begins with T1 in the spindle, its length on, outside of the block at X -50.
  RunResult run(const std::string& text, const Shape& shape = {},
                const std::string& start = "T1 M6 G43 H1\n", const CheckOptions& checks = {}) {
    auto machine = std::make_shared<machine::Machine>(*box_.machine());
    machine::SetupStock stock;
    stock.raw.size = Vec3(60, 40, 20);
    stock.raw.pitch = 0.25;
    stock.place = Vec3(0, 0, -100);
    machine::Setup setup;
    setup.stock = stock;
    Diagnostics out;
    const auto placed = machine::apply_setup(*machine, setup, box_.sources(), out);
    EXPECT_TRUE(placed);
    return run_program("G21 G90 G61 G17\n" + start + "S1000 M3 F1000\nG0 X-50 Y0\n" + text + "M2\n",
                       *placed, end_mill(shape), box_.sources(), checks);
  }
  BoxMachine box_;
};

constexpr double h = 0.25;

TEST_F(Cutting, TakesASlotOfItsExactVolume) {
  const RunResult r = run("G0 Z-85\nG1 X40\nG0 Z-70\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  for (const Finding& f : r.findings) ADD_FAILURE() << f.message;
  ASSERT_TRUE(r.summary.stock);
  const double area = 60 * 10 + 2 * 60 * 5;
  EXPECT_NEAR(r.summary.stock->initial_volume, 60 * 40 * 20, 1);
  EXPECT_NEAR(r.summary.stock->initial_volume - r.summary.stock->volume, 60 * 10 * 5,
              0.5 * h * area);
}

TEST_F(Cutting, KnowsWhenTheMaterialWent) {
  // A slot of 60 x 10 x 5 on the way of 90 mm at 1000 mm/min, then rapids that take nothing.
  const RunResult r = run("G0 Z-85\nG1 X40\nG0 Z-70\nG0 X-50\n");
  ASSERT_TRUE(r.summary.stock);
  const auto& removed = r.summary.stock->removed;
  double sum = 0, most = 0, begin = -1, end = 0;
  for (std::size_t i = 0; i < removed.values().size(); ++i) {
    const double here = removed.values()[i].value;
    if (here > 0 && begin < 0) begin = static_cast<double>(i) * removed.width();
    if (here > 0) end = static_cast<double>(i + 1) * removed.width();
    sum += here;
    most = std::max(most, here / removed.width());
  }
  EXPECT_NEAR(sum, r.summary.stock->initial_volume - r.summary.stock->volume, 1e-6 * sum);
  EXPECT_NEAR(end - begin, 5.4, 0.05);
  EXPECT_NEAR(most, sum / 5.4, 0.01 * most);
  EXPECT_LT(end, r.summary.cycle_time - 0.1);
}

TEST_F(Cutting, FindsARapidThroughStock) {
  const RunResult r = run("G0 Z-85\nG0 X40\n");
  const Finding& f = r.only(Kind::rapid_cut);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_EQ(f.span.line, 6u);
  EXPECT_EQ(f.body_a, "T1/cutter");
  EXPECT_EQ(f.body_b, "stock");
  EXPECT_EQ(f.pair, "cutter-stock");
  EXPECT_NEAR(f.u_first, 15.0 / 90, 2e-3);  // the cutter's front is 5 mm ahead of its axis
  EXPECT_NEAR(*f.depth, 60, 0.01);          // along its way
  EXPECT_NEAR(*f.value, 60 * 10 * 5, 0.5 * h * (60 * 10 + 2 * 60 * 5));
}

TEST_F(Cutting, LetsARapidTouchTheFaceAndNoMore) {
  EXPECT_EQ(run("G0 Z-80\nG0 X40\n").count(Kind::rapid_cut), 0);
  EXPECT_EQ(run("G0 Z-80.02\nG0 X40\n").count(Kind::rapid_cut), 1);
}

TEST_F(Cutting, LetsARapidGoBackThroughTheSlotThatWasCut) {
  const RunResult r = run("G0 Z-85\nG1 X40\nG0 X-50\n");
  EXPECT_EQ(r.count(Kind::rapid_cut), 0);
  EXPECT_EQ(r.verdict, Verdict::pass);
  // A tenth of a millimetre deeper it takes the floor.
  EXPECT_EQ(run("G0 Z-85\nG1 X40\nG0 Z-85.1\nG0 X-50\n").count(Kind::rapid_cut), 1);
}

TEST_F(Cutting, TakesTheCurveBetweenFeedAndRapidForFeed) {
  // The retract begins in the curve that rounds the corner, still with a part of the way along X.
  EXPECT_EQ(run("G64 P1\nG0 Z-85\nG1 X0\nG0 Z-70\n").count(Kind::rapid_cut), 0);
  EXPECT_GE(run("G64 P1\nG0 Z-85\nG0 X0\nG0 Z-70\n").count(Kind::rapid_cut), 1);
}

TEST_F(Cutting, NeedsATurningSpindle) {
  const RunResult r = run("M5\nG0 Z-85\nG1 X40\n");
  EXPECT_EQ(r.only(Kind::spindle_stopped_cut).span.line, 7u);
  EXPECT_EQ(run("M5\nG0 Z-79.9\nG1 X40\n").count(Kind::spindle_stopped_cut), 0);
}

TEST_F(Cutting, NeedsTheRightDirection) {
  EXPECT_EQ(run("M4\nG0 Z-85\nG1 X40\n").only(Kind::spindle_direction_cut).span.line, 7u);
  EXPECT_EQ(run("M4\nG0 Z-85\nG1 X40\n", {.left_hand = true}).verdict, Verdict::pass);
  EXPECT_EQ(run("G0 Z-85\nG1 X40\n", {.left_hand = true}).count(Kind::spindle_direction_cut), 1);
}

TEST_F(Cutting, NeedsATool) {
  const RunResult r = run("G0 X0\nG1 Z-85\n", {}, "");
  EXPECT_EQ(r.only(Kind::no_tool_cut).span.line, 5u);
  EXPECT_EQ(r.only(Kind::collision).body_b, "stock");  // and the spindle's nose goes in, too
  EXPECT_EQ(run("G0 X0\nG1 Z-79\n", {}, "").count(Kind::no_tool_cut), 0);
}

TEST_F(Cutting, KnowsToolsThatCantPlunge) {
  const std::string plunge = "G0 X0 Z-75\nG1 Z-85\nG0 Z-70\n";
  EXPECT_EQ(run(plunge).verdict, Verdict::pass);
  const RunResult r = run(plunge, {.center_cutting = false});
  EXPECT_EQ(r.only(Kind::plunge_not_center_cutting).span.line, 6u);
  // A ramp of 30° is well away from the axis.
  EXPECT_EQ(run("G0 X0 Z-80\nG1 X17.3 Z-90\nG0 Z-70\n", {.center_cutting = false})
                .count(Kind::plunge_not_center_cutting),
            0);
}

TEST_F(Cutting, TellsLongFeedMovesInTheAir) {
  const RunResult r = run("G0 Z-79\nG1 X-29\nG1 X-9.1\nG0 Z-70\n");
  EXPECT_EQ(r.only(Kind::air_cut).span.line, 6u);
  EXPECT_EQ(r.verdict, Verdict::pass);
  // Nothing is left for the second pass.
  EXPECT_EQ(run("G0 Z-85\nG1 X40\nG1 X-50\n").only(Kind::air_cut).span.line, 7u);
}

TEST_F(Cutting, FindsAShankInTheWall) {
  // Flutes of 10 mm under a shank 2 mm wider: 12 mm deep the shank is 2 mm below the face.
  const Shape wide{.flutes = 10, .shank = 6};
  const RunResult r = run("G0 Z-92\nG1 X40\nG0 Z-70\n", wide);
  const Finding& f = r.only(Kind::collision);
  EXPECT_EQ(f.body_a, "T1/shank");
  EXPECT_EQ(f.body_b, "stock");
  EXPECT_EQ(f.span.line, 6u);
  EXPECT_EQ(r.verdict, Verdict::fail);
  EXPECT_EQ(run("G0 Z-89\nG1 X40\nG0 Z-70\n", wide).verdict, Verdict::pass);
}

TEST_F(Cutting, LetsAShankOfTheCuttersDiameterFollowItsWall) {
  const Shape same{.flutes = 10, .shank = 5};
  const RunResult r = run("G0 Z-92\nG1 X40\n", same);
  // Above the flutes the block stands beside the slot's upper part: the shank runs into it.
  EXPECT_EQ(r.only(Kind::collision).body_a, "T1/shank");
  // In layers no deeper than the flutes it only follows the wall.
  const RunResult layers = run("G0 Z-89\nG1 X40\nG0 Z-95\nG1 X-40\n", same);
  for (const Finding& f : layers.findings) ADD_FAILURE() << f.message;
  EXPECT_EQ(layers.verdict, Verdict::pass);
}

TEST_F(Cutting, DrillsDeeperThanTheFlutesWithoutTheShankTouching) {
  // A plunge: the shank goes into the hole that the same move makes.
  const RunResult r = run("G0 X0 Z-75\nG1 Z-95\nG0 Z-70\n", {.flutes = 10, .shank = 4.5});
  for (const Finding& f : r.findings) ADD_FAILURE() << f.message;
  EXPECT_EQ(r.verdict, Verdict::pass);
}

TEST_F(Cutting, FindsAHolderOnTheFace) {
  // The holder's face is 40 mm above the tip: it touches when the tip is 40 mm below the face,
  // beside the block and with the holder reaching over it.
  const RunResult r = run("G0 X-36 Z-119\nG1 X-35.5\nG0 Z-70\n");
  EXPECT_EQ(r.verdict, Verdict::pass);
  const RunResult low = run("G0 X-55\nG0 Z-121\nG1 X-36\n");
  EXPECT_EQ(low.only(Kind::collision).body_a, "T1/holder");
}

// A program with a wrong offset has its holder in the stock all the time.
TEST_F(Cutting, FindsEveryContactWhenOnlyTheFirstAreMeasured) {
  const std::string deep = "G0 X-55\nG0 Z-125\nG1 X-36\nG1 X-30\nG3 X-20 Y10 R10\nG1 Y12 Z-124\n";
  const std::string start = "T1 M6 G43 H1\n";
  CheckOptions few;
  few.detailed = 2;
  const RunResult all = run(deep, {}, start), some = run(deep, {}, start, few);
  ASSERT_EQ(some.findings.size(), all.findings.size());
  std::size_t told = 0, measured = 0;
  for (std::size_t i = 0; i < all.findings.size(); ++i) {
    const Finding &a = all.findings[i], &b = some.findings[i];
    SCOPED_TRACE(a.message);
    EXPECT_EQ(b.message, a.message);
    EXPECT_EQ(b.block, a.block);
    EXPECT_EQ(b.t_first, a.t_first);
    EXPECT_EQ(b.t_end, a.t_end);
    if (a.kind != Kind::collision) continue;
    ++told;
    ASSERT_TRUE(a.depth);
    EXPECT_FALSE(b.points.empty());
    if (b.depth) {
      EXPECT_EQ(*b.depth, *a.depth);
    }
    measured += b.depth ? 1 : 0;
  }
  EXPECT_GE(told, 4U);
  EXPECT_GE(measured, 2U);
  EXPECT_LT(measured, told);
}

TEST_F(Cutting, CutsArcsToTheirVolume) {
  // A ring groove of radius 12, 10 wide, 5 deep.
  const RunResult r = run("G0 X12 Y0\nG0 Z-79\nG1 Z-85\nG3 X12 Y0 I-12 J0\nG0 Z-70\n");
  ASSERT_TRUE(r.summary.stock);
  const double exact = M_PI * (17 * 17 - 7 * 7) * 5;
  const double area = M_PI * (17 * 17 - 7 * 7) + 2 * M_PI * (17 + 7) * 5;
  EXPECT_NEAR(r.summary.stock->initial_volume - r.summary.stock->volume, exact, 0.5 * h * area);
  EXPECT_EQ(r.verdict, Verdict::pass);
}

// ---- engagement_limit: a slot, or a pass over the block's edge ----

TEST_F(Cutting, MeasuresTheDepthOfACut) {
  const std::string slot = "G0 Z-85\nG1 X40\n";
  const RunResult r = run(slot, {.limits = {.depth = 4.9}});
  const Finding& f = r.only(Kind::engagement_limit);
  EXPECT_EQ(f.severity, Severity::warning);
  EXPECT_EQ(f.span.line, 6u);
  EXPECT_EQ(f.quantity, "axial depth");
  EXPECT_NEAR(*f.value, 5, 1e-3);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_EQ(run(slot, {.limits = {.depth = 5}}).count(Kind::engagement_limit), 0);
  // A second pass a millimetre deeper has a depth of 1 mm.
  EXPECT_EQ(run(slot + "G0 Z-70\nG0 X-50\nG0 Z-86\nG1 X40\n", {.limits = {.depth = 4.9}})
                .count(Kind::engagement_limit),
            1);
}

TEST_F(Cutting, MeasuresTheWidthAndAngleOfACut) {
  // The block's edge is at Y -20: with the axis at Y -22 the cutter is 3 mm in, of a radius of 5:
  // from 90° to asin(2/5) of its circumference.
  const std::string edge = "G0 Y-22\nG0 Z-85\nG1 X40\n";
  const double angle = M_PI / 2 - std::asin(2.0 / 5);
  const RunResult r = run(edge, {.limits = {.width = 2.9, .angle = angle - 0.05}});
  ASSERT_EQ(r.count(Kind::engagement_limit), 2);
  for (const Finding& f : r.findings) {
    if (f.kind != Kind::engagement_limit) continue;
    if (f.quantity == "radial width") {
      EXPECT_NEAR(*f.value, 3, h);
    } else {
      EXPECT_NEAR(*f.value, angle * 180 / M_PI, 3.5);
    }
  }
  EXPECT_EQ(
      run(edge, {.limits = {.width = 3.001, .angle = angle + 0.001}}).count(Kind::engagement_limit),
      0);
  // A slot is as wide as the cutter and half of it is in.
  EXPECT_EQ(run("G0 Z-85\nG1 X40\n", {.limits = {.width = 10, .angle = M_PI}})
                .count(Kind::engagement_limit),
            0);
  EXPECT_EQ(run("G0 Z-85\nG1 X40\n", {.limits = {.width = 9.7, .angle = 3}})
                .count(Kind::engagement_limit),
            2);
}

TEST_F(Cutting, MeasuresTheRemovalRateAndTheChip) {
  // 10 mm × 5 mm × 1000 mm/min = 50 cm³/min where the whole cutter is in; 0.5 mm per tooth.
  const std::string slot = "G0 Z-85\nG1 X-20\nG1 X20\nG1 X40\n";
  const RunResult r = run(slot, {.limits = {.removal = 49.0 * 1000 / 60, .chip_load = 0.49}});
  int rates = 0;
  for (const Finding& f : r.findings) {
    if (f.quantity == "chip load") {
      EXPECT_NEAR(*f.value, 0.5, 1e-3);
    }
    if (f.quantity != "removal rate") continue;
    ++rates;
    EXPECT_EQ(f.span.line, 7u);
    EXPECT_NEAR(*f.value, 50, 0.5);
  }
  EXPECT_EQ(rates, 1);
  EXPECT_EQ(run(slot, {.limits = {.removal = 51.0 * 1000 / 60, .chip_load = 0.5}})
                .count(Kind::engagement_limit),
            0);
  // In the air nothing is asked of the tool.
  EXPECT_EQ(run("G0 Z-75\nG1 X40\n", {.limits = {.chip_load = 0.1}}).count(Kind::engagement_limit),
            0);
}

// ---- loose_piece ----

TEST_F(Cutting, FindsThePieceThatIsCutOff) {
  // Sawn through at X 15 in two layers: 10 mm of the 60 go, the piece of 10 x 40 x 20 is the small
  // one.
  const std::string saw = "G0 X15 Y-30\nG0 Z-90\nG1 Y30\nG0 Z-70\nG0 Y-30\nG0 Z-100\n";
  const RunResult r = run(saw + "G1 Y30\nG0 Z-70\n");
  const Finding& f = r.only(Kind::loose_piece);
  EXPECT_EQ(f.severity, Severity::warning);
  EXPECT_EQ(f.span.line, 11u);
  EXPECT_NEAR(*f.value, 10 * 40 * 20, 2 * h * 40 * 20);
  EXPECT_EQ(f.tool, 1);
  EXPECT_EQ(r.verdict, Verdict::pass);
  // A skin of 0.05 mm holds it, and so does a tab between the ends of two cuts.
  const std::string skin = "G0 X15 Y-30\nG0 Z-90\nG1 Y30\nG0 Z-70\nG0 Y-30\nG0 Z-99.95\n";
  EXPECT_EQ(run(skin + "G1 Y30\nG0 Z-70\n").count(Kind::loose_piece), 0);
  EXPECT_EQ(run(saw + "G1 Y10\nG0 Z-70\n").count(Kind::loose_piece), 0);
}

TEST_F(Cutting, SaysSoWhenTheToolHasNoShape) {
  auto tools = end_mill();
  tools.tools[0].pieces.clear();
  auto machine = std::make_shared<machine::Machine>(*box_.machine());
  machine::Setup setup;
  setup.stock.emplace();
  setup.stock->raw.size = Vec3(60, 40, 20);
  setup.stock->place = Vec3(0, 0, -100);
  Diagnostics out;
  const auto placed = machine::apply_setup(*machine, setup, box_.sources(), out);
  ASSERT_TRUE(placed);
  const RunResult r =
      run_program("G21 G90\nT1 M6 G43 H1\nS1000 M3 F1000\nG0 X-50\nG0 Z-85\nG1 X40\nM2\n", *placed,
                  tools, box_.sources());
  EXPECT_EQ(r.verdict, Verdict::unknown);
  EXPECT_FALSE(r.summary.stock);
}

}  // namespace
}  // namespace aircut::sim
