#include <gtest/gtest.h>

#include "interp/interp.h"
#include "interp/run_program.h"

namespace aircut::test {
namespace {

using Texts = std::vector<std::string>;

TEST(Interpreter, SaysTheStartStateFirst) {
  SourceMap sources;
  const Ran ran = run_program(sources, "M2\n");
  ASSERT_GE(ran.start.size(), 6u);
  EXPECT_TRUE(std::holds_alternative<canon::UseUnit>(ran.start[0].action));
  EXPECT_TRUE(std::holds_alternative<canon::WorkOffset>(ran.start[1].action));
}

TEST(Interpreter, ABlockWithAnErrorChangesNothing) {
  SourceMap sources;
  // #1 is set on the refused line, G91 and the tool table are changed there.
  Setting setting;
  tool::Tool tool;
  tool.number = 1;
  setting.tools.tools.push_back(tool);
  const Ran ran = run_program(sources,
                              "#1=5\nF100 #1=7 G91 M8 G1 X1 P9\nG10 L1 P1 Z7 H4\nG0 X#1\n"
                              "G43 H1\nG1 Y1\nM2\n",
                              setting);
  EXPECT_EQ(ran.kinds(), (Texts{"word_unused", "word_unused"}));
  EXPECT_EQ(ran.texts[0], "rapid X5 Y0 Z0");
  EXPECT_EQ(ran.texts[1], "tool_offset X0 Y0 Z0");
}

TEST(Interpreter, ReadsBeforeTheLineAndSetsAfterIt) {
  SourceMap sources;
  const Ran ran =
      run_program(sources, "#3=15\n#3=6 G0 X#3\nG0 X#3\n#1=1 #2=2\n#1=#2 #2=#1\nG0 X#1 Y#2\nM2\n");
  EXPECT_EQ(ran.texts[0], "rapid X15 Y0 Z0");
  EXPECT_EQ(ran.texts[1], "rapid X6 Y0 Z0");
  EXPECT_EQ(ran.texts[2], "rapid X2 Y1 Z0");
}

TEST(Interpreter, RotationIsInsideTheWorkOffset) {
  SourceMap sources;
  const Ran ran =
      run_program(sources,
                  "G10 L2 P1 X100 Y50 Z10 R30\nG53 G0 X0 Y0 Z0\nG10 L2 P1 X10 Y0 Z0 R90\n"
                  "G52 X5 Y2\nG0 X0 Y0\nM2\n");
  const AxisValues tip = end_tip(ran);
  EXPECT_NEAR(tip[Axis::x], 8, 1e-9);
  EXPECT_NEAR(tip[Axis::y], 5, 1e-9);
}

TEST(Interpreter, TheLengthOffsetMovesTheTipNotTheMachine) {
  SourceMap sources;
  Setting setting;
  tool::Tool tool;
  tool.number = 1;
  tool.offset[Axis::z] = 25.4;
  setting.tools.tools.push_back(tool);
  setting.options.start[Axis::z] = 100;
  const Ran ran = run_program(sources, "T1 M6\nG43 H1\nG0 X1\nG53 G0 Z0\nM2\n", setting);
  std::vector<double> z;
  for (const canon::Command& c : ran.commands)
    if (const auto* move = std::get_if<canon::Rapid>(&c.action)) z.push_back(move->end[Axis::z]);
  ASSERT_EQ(z.size(), 2u);
  EXPECT_NEAR(z[0], 74.6, 1e-12);   // the machine stays at 100
  EXPECT_NEAR(z[1], -25.4, 1e-12);  // the machine goes to 0
}

TEST(Interpreter, ArcCentresFollowFromTheRadius) {
  SourceMap sources;
  const Ran ran = run_program(sources, "F100\nG2 X10 Y0 R10\nG2 X0 Y0 R-10\nM2\n");
  for (const canon::Command& c : ran.commands) {
    const auto* arc = std::get_if<canon::ArcFeed>(&c.action);
    if (!arc) continue;
    EXPECT_NEAR(arc->centre.x(), 5, 1e-9);
    EXPECT_NEAR(arc->centre.y(), -8.660254, 1e-6);
    EXPECT_EQ(arc->turns, -1);
  }
}

TEST(Interpreter, CommandsOfLoopsAndCallsSayHowTheyWereReached) {
  SourceMap sources;
  const Ran ran =
      run_program(sources,
                  "o<pocket> sub\no100 while [#2 LT 3]\nG0 X#2\n#2=[#2+1]\no100 endwhile\n"
                  "o<pocket> endsub\no<pocket> call [3] [1]\nM2\n");
  ASSERT_EQ(ran.texts[1], "rapid X2 Y0 Z0");
  const CallFrame* frame = ran.commands[1].span.calls.get();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->text(), "o100 while, pass 2");
  ASSERT_TRUE(frame->site.calls);
  EXPECT_EQ(frame->site.calls->text(), "o<pocket> call [3] [1]");
  EXPECT_EQ(frame->site.calls->site.line, 7u);
  EXPECT_FALSE(frame->site.calls->site.calls);
}

TEST(Interpreter, OneMistakeGivesOneMessage) {
  SourceMap sources;
  // The start point of the second arc is known only from the refused line.
  EXPECT_EQ(run_program(sources, "F100\nG1 X10 H3\nG2 X20 I5\nG2 X30 I5\nG0 X0\nM2\n").kinds(),
            (Texts{"word_unused"}));
  EXPECT_EQ(run_program(sources, "G1 X1 F100 H1\nX2\nG1 X3\nM2\n").kinds(), (Texts{"word_unused"}));
  EXPECT_EQ(run_program(sources, "#<a>=[1/0]\nG0 X#<a>\nG0 X#<b>\nM2\n").kinds(),
            (Texts{"math_domain", "parameter_undefined"}));
}

TEST(Interpreter, StopsAtTheFirstErrorWhenAsked) {
  SourceMap sources;
  Setting setting;
  setting.options.keep_going = false;
  const Ran ran = run_program(sources, "G0 X1\nG0 X2 H1\nG0 X3 H1\nM2\n", setting);
  EXPECT_EQ(ran.kinds().size(), 1u);
  EXPECT_EQ(ran.last_text(), "rapid X1 Y0 Z0");
  EXPECT_FALSE(ran.statistics.ended);
}

TEST(Interpreter, AnErrorInALoopIsToldOnce) {
  SourceMap sources;
  const Ran ran = run_program(sources, "o1 repeat [50]\nG0 X1 H1\no1 endrepeat\nM2\n");
  EXPECT_EQ(ran.kinds(), (Texts{"word_unused"}));
  EXPECT_TRUE(ran.statistics.ended);
}

TEST(Interpreter, AnEndlessLoopEndsWithTheValuesOfItsCondition) {
  SourceMap sources;
  Setting setting;
  setting.options.limits.max_idle_blocks = 300;
  const Ran ran =
      run_program(sources, "#<n>=4\no7 while [#<n> GT #3]\n#5=1\no7 endwhile\nM2\n", setting);
  EXPECT_EQ(ran.kinds(), (Texts{}));  // it is our limit, not the control's
  ASSERT_EQ(ran.kinds(Severity::warning), (Texts{"loop_limit"}));
  const Diagnostic& d = ran.diagnostics.list().front();
  EXPECT_EQ(d.span.line, 2u);
  EXPECT_NE(d.message.find("#<n> = 4, #3 = 0"), std::string::npos) << d.message;
  EXPECT_TRUE(ran.statistics.limit_reached);
}

TEST(Interpreter, CachedLinesGiveTheSameAsFreshOnes) {
  SourceMap sources;
  std::string unrolled = "#1=0\n";
  for (int i = 0; i < 5; ++i) unrolled += "G0 X[#1*2] Y[#1+1]\n#1=[#1+1]\n";
  const Ran loop = run_program(
      sources, "#1=0\no1 while [#1 LT 5]\nG0 X[#1*2] Y[#1+1]\n#1=[#1+1]\no1 endwhile\nM2\n");
  EXPECT_EQ(loop.texts, run_program(sources, unrolled + "M2\n").texts);
}

TEST(Interpreter, PlainMovesGiveTheSameAsTheWayThroughTheTable) {
  const Texts lines = {"G21 F100",   "G10 L2 P1 X3 Y4 Z5",
                       "G92 X1 A7",  "G0 X1 Y2",
                       "Z3 A10",     "G1 X4",
                       "Y[2*3] C-5", "G20",
                       "X1",         "G91",
                       "X1 Y1",      "G0 Z-1 B2",
                       "G90",        "G81 Z-3 R2",
                       "G1",         "G10 L2 P1 R30",
                       "X1 Y1",      "G93",
                       "X2 F3",      "Y5",
                       "G94 F10",    "G43.1 Z2",
                       "X3",         "M2"};
  std::string plain, commented;
  for (const std::string& line : lines) {
    plain += line + "\n";
    commented += line + " (c)\n";
  }
  SourceMap sources;
  const Ran one = run_program(sources, plain);
  const Ran two = run_program(sources, commented);
  Texts without_comments;
  for (const std::string& text : two.texts)
    if (text != "comment c") without_comments.push_back(text);
  EXPECT_EQ(one.texts, without_comments);
  EXPECT_EQ(one.kinds(), two.kinds());
  EXPECT_GT(one.texts.size(), lines.size());
}

TEST(Interpreter, FilesOfSubsAreFoundInTheFolderAndThePath) {
  SourceMap sources;
  Setting setting;
  setting.options.sub_path = {"lib"};
  setting.files["folder/here.ngc"] = "o<here> sub\nG0 X1\no<here> endsub\nM2\n";
  setting.files["lib/there.ngc"] = "%\no<there> sub\nG0 X2\no<there> endsub [9]\n%\n";
  const Ran ran = run_program(
      sources, "o<HERE> call\no<there> call\nG0 X#<_value>\no<nowhere> call\nM2\n", setting);
  EXPECT_EQ(ran.kinds(), (Texts{"sub_missing"}));
  EXPECT_EQ(ran.texts[0], "rapid X1 Y0 Z0");
  EXPECT_EQ(ran.texts[1], "rapid X2 Y0 Z0");
  EXPECT_EQ(ran.texts[2], "rapid X9 Y0 Z0");
}

TEST(Interpreter, NamesOfSubsCanNotLeaveTheirFolder) {
  SourceMap sources;
  Setting setting;
  setting.files["folder/../x.ngc"] = "o<../x> sub\no<../x> endsub\n";
  for (const char* name : {"../x", "/etc/x", "a/../../x"})
    EXPECT_EQ(run_program(sources, std::string("o<") + name + "> call\nM2\n", setting).kinds(),
              (Texts{"path_refused"}))
        << name;
}

TEST(Interpreter, ProbingHandsTheHitBackToTheProgram) {
  SourceMap sources;
  const SourceText& text = sources.add("p.ngc", "F100\nG54\nG38.2 Z-10\nG0 X#5063 Y#5070\nM2\n");
  Diagnostics out;
  interp::Interpreter run(text, {}, {}, {}, nullptr, out);
  std::string last;
  while (auto command = run.next()) {
    if (std::holds_alternative<canon::Probe>(command->action)) {
      AxisValues hit;
      hit[Axis::z] = -4;
      run.resume({hit, true});
    }
    if (std::holds_alternative<canon::Rapid>(command->action))
      last = canon::to_text(command->action);
  }
  EXPECT_EQ(last, "rapid X-4 Y1 Z-4");
  EXPECT_EQ(out.errors(), 0u);
}

TEST(Interpreter, KeepsWhatTheParameterFileIsFor) {
  SourceMap sources;
  Setting setting;
  setting.parameters.values = {{5161, 7}, {5220, 2}, {5241, 30}, {31, 4}};
  const Ran ran = run_program(sources, "G0 X1\n#31=5\nG28.1\nG92 X0\nM2\n", setting);
  EXPECT_EQ(ran.texts[0], "rapid X31 Y0 Z0");
  EXPECT_EQ(ran.parameters.values.at(31), 5);
  EXPECT_EQ(ran.parameters.values.at(5161), 31);
  EXPECT_EQ(ran.parameters.values.at(5211), 1);
  EXPECT_EQ(ran.parameters.values.at(5220), 1);  // M2 selects G54
}

TEST(Interpreter, SettingsFromOutsideReachTheProgram) {
  SourceMap sources;
  Setting setting;
  setting.options.set = {{"#100", 3}, {"#<depth>", -2}, {"#5420", 1}};
  const Ran ran = run_program(sources, "G0 X#100 Z#<depth>\nM2\n", setting);
  EXPECT_EQ(ran.texts[0], "rapid X3 Y0 Z-2");
  EXPECT_EQ(ran.kinds(), (Texts{"parameter_range"}));
}

TEST(Interpreter, RefusesWhatIsNoText) {
  SourceMap sources;
  EXPECT_EQ(run_program(sources, std::string("\xff\xfeG\0", 4)).kinds(), (Texts{"encoding"}));
  std::string binary;
  for (int i = 0; i < 400; ++i) binary += static_cast<char>(i % 7);
  EXPECT_EQ(run_program(sources, binary).kinds(), (Texts{"encoding"}));
  EXPECT_EQ(run_program(sources, "").kinds(), (Texts{"empty_program"}));
  EXPECT_EQ(run_program(sources, std::string("G0 X1\0\nM2\n", 10)).kinds(),
            (Texts{"bad_character"}));
}

TEST(Interpreter, CountsMovesThatOneLineMayMake) {
  SourceMap sources;
  const Ran ran = run_program(sources, "F100\nG81 X1 Z-1 R1 L999999999\nG0 X1\nM2\n");
  EXPECT_EQ(ran.kinds(), (Texts{"limit_reached"}));
}

TEST(Compensation, RoundsOutsideCornersAndShortensInsideOnes) {
  SourceMap sources;
  const Ran ran = run_program(
      sources, "F100\nG0 X-20 Y-20\nG41.1 D6.35\nG1 X-10 Y0\nX20\nY30\nG40\nG1 X0 Y50\nM2\n");
  // From (-20,-20): the entry ends on the normal of its own direction.
  EXPECT_EQ(ran.texts[2], "feed X-12.839806 Y1.419903 Z0");
  const auto* corner = std::get_if<canon::ArcFeed>(&ran.commands[3].action);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->end[Axis::x], -10, 1e-9);
  EXPECT_NEAR(corner->end[Axis::y], 3.175, 1e-9);
  EXPECT_NEAR(corner->centre.y(), 0, 1e-9);
  EXPECT_EQ(ran.texts[4], "feed X16.825 Y3.175 Z0");  // shortened at the inside corner
  EXPECT_EQ(ran.commands[4].span.line, 5u);
  EXPECT_EQ(ran.texts[5], "feed X16.825 Y30 Z0");
}

}  // namespace
}  // namespace aircut::test
