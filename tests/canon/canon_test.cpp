#include "canon/canon.h"

#include <gtest/gtest.h>

#include <numbers>

namespace aircut::canon {
namespace {

constexpr double pi = std::numbers::pi;

AxisValues xyz(double x, double y, double z) { return {{x, y, z}}; }

// ---- motion ----------------------------------------------------------------------------------

TEST(Motion, IsWhatMovesAxesAndADwellDoesNot) {
  EXPECT_TRUE(is_motion(Rapid{}));
  EXPECT_TRUE(is_motion(LinearFeed{}));
  EXPECT_TRUE(is_motion(ArcFeed{}));
  EXPECT_TRUE(is_motion(SplineFeed{}));
  EXPECT_TRUE(is_motion(SyncFeed{}));
  EXPECT_TRUE(is_motion(Probe{}));
  EXPECT_FALSE(is_motion(Dwell{1}));
  EXPECT_FALSE(is_motion(WorkOffset{}));
}

TEST(Motion, EndsWhereItsCommandSays) {
  const AxisValues start = xyz(1, 2, 3);
  EXPECT_EQ(end_of(Rapid{xyz(4, 5, 6)}, start), xyz(4, 5, 6));
  EXPECT_EQ(end_of(Probe{.end = xyz(4, 5, 6)}, start), xyz(4, 5, 6));
  EXPECT_EQ(end_of(Dwell{1}, start), start);
}

TEST(Motion, OfARigidTapComesBackToItsStart) {
  const AxisValues start = xyz(1, 2, 3);
  EXPECT_EQ(end_of(SyncFeed{.end = xyz(1, 2, -9), .rigid_tap = true}, start), start);
  EXPECT_EQ(end_of(SyncFeed{.end = xyz(1, 2, -9)}, start), xyz(1, 2, -9));
}

TEST(Motion, OfASplineEndsAtItsLastPointAndKeepsOtherAxes) {
  const SplineFeed spline{.points = {{0, 0, 1}, {5, 5, 1}, {7, 8, 1}}};
  EXPECT_EQ(end_of(spline, xyz(0, 0, 3)), xyz(7, 8, 3));
}

// ---- text ------------------------------------------------------------------------------------

TEST(Text, ListsXYZAlwaysAndOtherAxesWhenTheyAreNotZero) {
  AxisValues end = xyz(10, 0, 5);
  EXPECT_EQ(to_text(Rapid{end}), "rapid X10 Y0 Z5");
  end[Axis::b] = pi / 2;
  end[Axis::w] = -0.125;
  EXPECT_EQ(to_text(LinearFeed{end}), "feed X10 Y0 Z5 B90 W-0.125");
}

TEST(Text, HidesTheNoiseOfSums) {
  EXPECT_EQ(to_text(Rapid{xyz(0.1 + 0.2, -1e-12, 100)}), "rapid X0.3 Y0 Z100");
}

TEST(Text, OfAnArcLeavesOutTheCentreAlongTheNormal) {
  ArcFeed arc{.end = xyz(10, 0, -1), .centre = {5, 0, 99}, .turns = -1};
  EXPECT_EQ(to_text(arc), "arc xy cw X10 Y0 Z-1 centre X5 Y0");
  arc.turns = 3;
  arc.normal = Vec3::UnitY();
  arc.plane = Plane::zx;
  EXPECT_EQ(to_text(arc), "arc zx ccw X10 Y0 Z-1 centre X5 Z99 turns 3");
  arc.normal = Vec3(0.6, 0.8, 0);
  EXPECT_EQ(to_text(arc), "arc zx ccw X10 Y0 Z-1 centre X5 Y0 Z99 normal 0.6 0.8 0 turns 3");
}

TEST(Text, GivesAFeedPerMinuteWithItsRotaryReading) {
  EXPECT_EQ(to_text(SetFeedRate{10, 600 * pi / 180 / 60}), "feed_rate 600");
  EXPECT_EQ(to_text(SetFeedRate{254.0 / 60, 10 * pi / 180 / 60}), "feed_rate 254 rotary 10");
  EXPECT_EQ(to_text(SetFeedRate{0.1}), "feed_rate 0.1");
}

TEST(Text, ShowsControlCharactersOfProgramText) {
  EXPECT_EQ(to_text(Message{Message::Kind::message, "a\x1b[2J"}), "message a^[[2J");
}

TEST(Text, NamesASpindleOnlyWhenItIsNotTheFirst) {
  EXPECT_EQ(to_text(TurnSpindle{.spindle = 0, .turn = SpindleTurn::clockwise}), "spindle cw");
  EXPECT_EQ(to_text(TurnSpindle{.spindle = 2, .turn = SpindleTurn::stop}), "spindle stop $2");
  EXPECT_EQ(to_text(SetSpindleMode{.css_max_rpm = 2000}), "spindle_mode surface_speed max 2000");
  EXPECT_EQ(to_text(SetSpindleMode{.css_max_rpm = 1e30}), "spindle_mode surface_speed");
}

TEST(Text, OfEveryCommandIsOneLineWithAWordFirst) {
  const std::vector<Action> all = {Rapid{},
                                   LinearFeed{},
                                   ArcFeed{},
                                   SplineFeed{},
                                   Dwell{},
                                   SyncFeed{},
                                   Probe{},
                                   SetFeedMode{},
                                   SetFeedRate{},
                                   SelectPlane{},
                                   UseUnit{},
                                   WorkOffset{},
                                   WorkRotation{},
                                   G92Offset{},
                                   ProgramMap{},
                                   ToolLengthOffset{},
                                   SetPathMode{},
                                   SetNaiveCam{},
                                   SetSpindleMode{},
                                   SetSpindleSpeed{},
                                   TurnSpindle{},
                                   OrientSpindle{},
                                   SelectTool{},
                                   ChangeTool{},
                                   SetToolNumber{},
                                   Coolant{},
                                   Override{},
                                   DigitalOutput{},
                                   AnalogOutput{},
                                   SwitchKinematics{},
                                   WaitInput{},
                                   UserCode{},
                                   ProgramStop{},
                                   PalletChange{},
                                   ProgramEnd{},
                                   Message{},
                                   LogFile{LogFile::Kind::close, ""}};
  EXPECT_EQ(all.size(), std::variant_size_v<Action>);
  for (const Action& action : all) {
    const std::string text = to_text(action);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    ASSERT_FALSE(text.empty());
    EXPECT_TRUE(std::islower(static_cast<unsigned char>(text[0])));
    const std::string json = to_json({action, {}, 1});
    EXPECT_TRUE(json.starts_with("{\"do\":\"") && json.ends_with("}")) << json;
  }
}

// ---- JSON ------------------------------------------------------------------------------------

TEST(Json, CarriesUnitsInItsKeys) {
  AxisValues end = xyz(1, 2, 3);
  end[Axis::a] = pi;
  EXPECT_EQ(to_json({Rapid{end}, {}, 7}),
            R"({"do":"rapid","x_mm":1,"y_mm":2,"z_mm":3,"a_deg":180,"block":7})");
}

TEST(Json, NamesThePlaceAndWhatWasExpanded) {
  SourceMap sources;
  const SourceText& text = sources.add("a\"b.ngc", "G83\n");
  const SourceSpan span{.text = &text, .begin = 0, .length = 3, .line = 1};
  EXPECT_EQ(to_json({Dwell{0.5}, span, 2, "G83 peck 1"}),
            R"({"do":"dwell","time_s":0.5,"file":"a\"b.ngc","line":1,"block":2,)"
            R"("expanded":"G83 peck 1"})");
}

TEST(Json, IsValidForAnyBytes) {
  const Message hostile{Message::Kind::message, "\x01\"\\\xff\xc3\xa9\xed\xa0\x80\n"};
  EXPECT_EQ(to_json({hostile, {}, 1}),
            "{\"do\":\"message\",\"text\":\"\\u0001\\\"\\\\\\ufffd\xc3\xa9\\ufffd\\ufffd\\ufffd"
            "\\u000a\",\"block\":1}");
}

// ---- rs274 form ------------------------------------------------------------------------------

/// All lines for a stream, without the six of the header.
std::string trace(const std::vector<Command>& commands) {
  Rs274Writer writer(Unit::millimetre);
  std::string out;
  for (const Command& command : commands) out += writer.write(command);
  out += writer.finish();
  for (int i = 0; i < 6; ++i) out.erase(0, out.find('\n') + 1);
  return out;
}

TEST(Rs274Form, TellsTheStartStateInSixLines) {
  Rs274Writer writer;
  EXPECT_EQ(writer.write({UseUnit{Unit::millimetre}, {}, 0}), "");
  EXPECT_EQ(writer.write({WorkOffset{2, xyz(1, 2, 3)}, {}, 0}), "");
  EXPECT_EQ(writer.write({Dwell{1}, {}, 1}),
            "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
            "    2 N..... SET_G5X_OFFSET(2, 1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)\n"
            "    3 N..... SET_G92_OFFSET(0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n"
            "    4 N..... SET_XY_ROTATION(0.0000)\n"
            "    5 N..... SET_FEED_REFERENCE(CANON_XYZ)\n"
            "    6 N..... ON_RESET()\n"
            "    7 N..... DWELL(1.0000)\n");
}

// interp.md section 5: G54 X10 R90, then G52 X5 Y2: program (0,0) is machine (8,5).
TEST(Rs274Form, TakesPointsBackThroughOffsetAndRotation) {
  EXPECT_EQ(trace({{WorkOffset{1, xyz(10, 0, 0)}, {}, 1},
                   {WorkRotation{pi / 2}, {}, 1},
                   {G92Offset{xyz(5, 2, 0)}, {}, 2},
                   {LinearFeed{xyz(8, 5, 0)}, {}, 3}}),
            "    7 N..... SET_G5X_OFFSET(1, 10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n"
            "    8 N..... SET_XY_ROTATION(90.0000)\n"
            "    9 N..... SET_G92_OFFSET(5.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n"
            "   10 N..... STRAIGHT_FEED(0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n");
}

TEST(Rs274Form, IsInTheUnitInForce) {
  EXPECT_EQ(trace({{UseUnit{Unit::inch}, {}, 1},
                   {SetFeedRate{25.4 / 60, 1}, {}, 1},
                   {Rapid{xyz(25.4, 50.8, 0)}, {}, 2},
                   {ToolLengthOffset{xyz(0, 0, 12.7)}, {}, 3},
                   {SetSpindleMode{0, 2000}, {}, 4},
                   {SetSpindleSpeed{0, 30.48}, {}, 4}}),
            "    7 N..... USE_LENGTH_UNITS(CANON_UNITS_INCHES)\n"
            "    8 N..... SET_FEED_RATE(1.0000)\n"
            "    9 N..... STRAIGHT_TRAVERSE(1.0000, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n"
            "   10 N..... USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 0.5000, 0.0000 0.0000 0.0000, "
            "0.0000 0.0000 0.0000)\n"
            "   11 N..... SET_SPINDLE_MODE(0 2000.0000)\n"
            "   12 N..... SET_SPINDLE_SPEED(0, 100.0000)\n");
}

TEST(Rs274Form, NamesTheAxesOfAnArcInTheOrderOfItsPlane) {
  const auto line = [](Plane plane, const Vec3& normal) {
    AxisValues end = xyz(1, 2, 3);
    end[Axis::b] = pi;
    return trace({{ArcFeed{.end = end,
                           .centre = {4, 5, 6},
                           .normal = normal,
                           .turns = -2,
                           .plane = plane},
                   {},
                   1}})
        .substr(13);
  };
  EXPECT_EQ(line(Plane::xy, Vec3::UnitZ()),
            "ARC_FEED(1.0000, 2.0000, 4.0000, 5.0000, -2, 3.0000, 0.0000, 180.0000, 0.0000)\n");
  EXPECT_EQ(line(Plane::zx, Vec3::UnitY()),
            "ARC_FEED(3.0000, 1.0000, 6.0000, 4.0000, -2, 2.0000, 0.0000, 180.0000, 0.0000)\n");
  EXPECT_EQ(line(Plane::yz, Vec3::UnitX()),
            "ARC_FEED(2.0000, 3.0000, 5.0000, 6.0000, -2, 1.0000, 0.0000, 180.0000, 0.0000)\n");
}

// Produced by the reference for: G93, G1 X10 F10, G2 X20 I5 Z5 F10, G1 X20.
TEST(Rs274Form, GivesEachInverseTimeMoveItsRate) {
  EXPECT_EQ(trace({{SetFeedMode{FeedMode::inverse_time}, {}, 1},
                   {SetFeedRate{10.0 / 60}, {}, 2},
                   {LinearFeed{xyz(10, 0, 0)}, {}, 2},
                   {SetFeedRate{10.0 / 60}, {}, 3},
                   {ArcFeed{.end = xyz(20, 0, 5), .centre = {15, 0, 0}, .turns = -1}, {}, 3},
                   {LinearFeed{xyz(20, 0, 5)}, {}, 4}}),
            "    7 N..... SET_FEED_MODE(0, 0)\n"
            "    8 N..... SET_FEED_RATE(100.0000)\n"
            "    9 N..... STRAIGHT_FEED(10.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)\n"
            "   10 N..... SET_FEED_RATE(164.8454)\n"
            "   11 N..... ARC_FEED(20.0000, 0.0000, 15.0000, 0.0000, -1, 5.0000, 0.0000, 0.0000, "
            "0.0000)\n"
            "   12 N..... SET_FEED_RATE(0.1000)\n"
            "   13 N..... STRAIGHT_FEED(20.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n");
}

TEST(Rs274Form, KnowsThatALengthOffsetMovesTheTip) {
  const std::string out = trace({{ToolLengthOffset{xyz(10, 0, 0)}, {}, 1},
                                 {SetFeedMode{FeedMode::inverse_time}, {}, 2},
                                 {SetFeedRate{1.0 / 60}, {}, 3},
                                 {LinearFeed{xyz(-30, 0, 0)}, {}, 3}});
  EXPECT_NE(out.find("SET_FEED_RATE(20.0000)"), std::string::npos) << out;
}

TEST(Rs274Form, OpensAndClosesSynchronisationOncePerBlock) {
  EXPECT_EQ(trace({{SyncFeed{.end = xyz(0, 0, -1), .per_revolution = 2}, {}, 1},
                   {SyncFeed{.end = xyz(0, 0, -2), .per_revolution = 2}, {}, 1},
                   {SyncFeed{.end = xyz(0, 0, -3), .per_revolution = 1}, {}, 2}}),
            "    7 N..... START_SPEED_FEED_SYNC(2.000000,0)\n"
            "    8 N..... STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)\n"
            "    9 N..... STRAIGHT_FEED(0.0000, 0.0000, -2.0000, 0.0000, 0.0000, 0.0000)\n"
            "   10 N..... STOP_SPEED_FEED_SYNCH()\n"
            "   11 N..... START_SPEED_FEED_SYNC(1.000000,0)\n"
            "   12 N..... STRAIGHT_FEED(0.0000, 0.0000, -3.0000, 0.0000, 0.0000, 0.0000)\n"
            "   13 N..... STOP_SPEED_FEED_SYNCH()\n");
}

TEST(Rs274Form, OfARigidTapHasXYZOnlyAndClosesAtOnce) {
  EXPECT_EQ(
      trace({{SyncFeed{.end = xyz(0, 0, -2), .per_revolution = 1.5, .rigid_tap = true}, {}, 1}}),
      "    7 N..... START_SPEED_FEED_SYNC(1.500000,0)\n"
      "    8 N..... RIGID_TAP(0.0000, 0.0000, -2.0000)\n"
      "    9 N..... STOP_SPEED_FEED_SYNCH()\n");
}

TEST(Rs274Form, ShowsTheNumberOfTheBlock) {
  SourceMap sources;
  const SourceText& text = sources.add("a.ngc", " / n 1 0 M8\n");
  const SourceSpan span{.text = &text, .begin = 0, .length = 3, .line = 1};
  EXPECT_EQ(trace({{Coolant{.on = true}, span, 1}}), "    7 N10    FLOOD_ON()\n");
}

TEST(Rs274Form, UsesTheReferencesNames) {
  EXPECT_EQ(trace({{SelectPlane{Plane::zx}, {}, 1},
                   {SelectPlane{Plane::uv}, {}, 1},
                   {SetPathMode{PathMode::continuous, 0.1}, {}, 1},
                   {SetNaiveCam{0.05}, {}, 1},
                   {TurnSpindle{.spindle = 1, .turn = SpindleTurn::counterclockwise}, {}, 1},
                   {OrientSpindle{.angle = pi / 4, .direction = 2}, {}, 1},
                   {ChangeTool{3}, {}, 1},
                   {SetToolNumber{4}, {}, 1},
                   {Override{Override::Kind::speed, false, 0}, {}, 1},
                   {DigitalOutput{.index = 2, .on = true, .with_motion = true}, {}, 1},
                   {AnalogOutput{.index = 2, .value = 0.5}, {}, 1},
                   {ProgramStop{true}, {}, 1},
                   {Message{Message::Kind::comment, "hello"}, {}, 1},
                   {Message{Message::Kind::print, "to the console"}, {}, 1},
                   {LogFile{LogFile::Kind::open, "a.txt"}, {}, 1},
                   {ProgramEnd{}, {}, 1}}),
            "    7 N..... SELECT_PLANE(CANON_PLANE_XZ)\n"
            "    8 N..... SELECT_PLANE(CANON_PLANE_UNKNOWN)\n"
            "    9 N..... SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.100000)\n"
            "   10 N..... SET_NAIVECAM_TOLERANCE(0.0500)\n"
            "   11 N..... START_SPINDLE_COUNTERCLOCKWISE(1)\n"
            "   12 N..... ORIENT_SPINDLE(0, 45.0000, 2)\n"
            "   13 N..... CHANGE_TOOL(3)\n"
            "   14 N..... CHANGE_TOOL_NUMBER(4)\n"
            "   15 N..... DISABLE_SPEED_OVERRIDE(0)\n"
            "   16 N..... SET_MOTION_OUTPUT_BIT(2)\n"
            "   17 N..... SET_AUX_OUTPUT_VALUE(2,0.500000)\n"
            "   18 N..... OPTIONAL_PROGRAM_STOP()\n"
            "   19 N..... COMMENT(\"hello\")\n"
            "to the console\n"
            "   20 N..... LOGOPEN(\"a.txt\")\n"
            "   21 N..... PROGRAM_END()\n");
}

}  // namespace
}  // namespace aircut::canon
