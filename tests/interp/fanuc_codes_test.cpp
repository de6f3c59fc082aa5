// One program per code of Fanuc-like controls: what it gives, or why it is refused.
#include <gtest/gtest.h>

#include "interp/run_program.h"

namespace aircut::test {
namespace {

using interp::Dialect;

Setting control(Dialect dialect, bool lathe = false) {
  Setting setting;
  setting.options.dialect = dialect;
  setting.options.lathe = lathe;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z})
    if (!(lathe && axis == Axis::y)) setting.options.axes.add(axis);
  for (int number = 1; number <= 3; ++number) {
    tool::Tool tool;
    tool.number = number;
    tool.offset[Axis::x] = lathe ? 10 * number : 0;
    tool.offset[Axis::z] = 100 + number;
    tool.diameter = 2 * number;
    tool.orientation = lathe ? 3 : 0;
    setting.tools.tools.push_back(tool);
  }
  setting.parameters.values = {{5161, 0},  {5181, 10},  {5182, 20},
                               {5183, 30}, {20181, 11}, {20183, 31}};
  return setting;
}

const Setting fanuc = control(Dialect::fanuc), haas = control(Dialect::haas),
              fanuc_lathe = control(Dialect::fanuc, true);

/// The commands of the lines behind the first `skip` ones, joined.
std::string commands_of(const std::string& program, const Setting& setting, unsigned skip) {
  SourceMap sources;
  const Ran ran = run_program(sources, program + "\nM30\n", setting);
  std::string out;
  for (const Diagnostic& d : ran.diagnostics.list())
    if (d.severity == Severity::error) out += "error " + d.kind + ": " + d.message + " | ";
  unsigned last = 0;
  for (const char c : program) last += c == '\n';
  for (std::size_t i = 0; i < ran.commands.size(); ++i) {
    const std::uint64_t line = ran.commands[i].span.line;
    if (line <= skip || line > last + 1) continue;
    out += (out.empty() ? "" : " | ") + ran.texts[i];
  }
  return out.empty() ? "nothing" : out;
}

std::vector<std::string> kinds_of(const std::string& program, const Setting& setting,
                                  Severity severity) {
  SourceMap sources;
  return run_program(sources, program + "\nM30\n", setting).kinds(severity);
}

struct Case {
  const Setting& setting;
  const char* before;  ///< lines that lead there
  const char* line;
  const char* gives;
};

void check(std::initializer_list<Case> cases) {
  for (const Case& c : cases) {
    const std::string before = c.before;
    unsigned lines = before.empty() ? 0 : 1;
    for (const char ch : before) lines += ch == '\n';
    EXPECT_EQ(commands_of(before + (before.empty() ? "" : "\n") + c.line, c.setting, lines),
              c.gives)
        << before << "\n"
        << c.line;
  }
}

TEST(FanucCodes, SelectWorkSystems) {
  const char* offsets = "G10 L2 P2 X2. Y0 Z0\nG10 L20 P3 X30.\nG10 L20 P99 X99.";
  check({{fanuc, offsets, "G55", "work_offset 2 X2 Y0 Z0"},
         {fanuc, offsets, "G54", "nothing"},
         {fanuc, offsets, "G54.1 P3", "work_offset 103 X30 Y0 Z0"},
         {fanuc, offsets, "G54 P3", "work_offset 103 X30 Y0 Z0"},
         {fanuc, "G55\nG10 L2 P0 Z-5.", "G56", "work_offset 3 X0 Y0 Z-5"},
         {fanuc, "", "G10 L20 P300 X1.\nG54.1 P300", "work_offset 400 X1 Y0 Z0"},
         {haas, offsets, "G154 P3", "work_offset 103 X30 Y0 Z0"},
         {haas, offsets, "G112", "work_offset 103 X30 Y0 Z0"},
         {haas, offsets, "G154 P99", "work_offset 199 X99 Y0 Z0"}});
  EXPECT_EQ(kinds_of("G54.1", fanuc, Severity::error), std::vector<std::string>{"word_missing"});
  EXPECT_EQ(kinds_of("G154 P100", haas, Severity::error), std::vector<std::string>{"word_value"});
  EXPECT_EQ(kinds_of("G154 P1", fanuc, Severity::error), std::vector<std::string>{"unknown_code"});
}

TEST(FanucCodes, SetAndShiftWorkSystems) {
  check({{fanuc, "", "G10 L2 P1 X5.", "work_offset 1 X5 Y0 Z0"},
         {fanuc, "G10 L2 P1 X5.\nG91", "G10 L2 P1 X1.", "work_offset 1 X6 Y0 Z0"},
         {fanuc, "", "G52 X5. Z1.", "g92_offset X5 Y0 Z1"},
         {fanuc, "G52 X5. Z1.", "G52 X0", "g92_offset X0 Y0 Z1"},
         {fanuc, "G52 X5.\nG55", "G0 X1. Y0", "rapid X6 Y0 Z0"},
         {fanuc, "G0 X10.", "G92 X0", "g92_offset X10 Y0 Z0"},
         {fanuc, "G0 X10.\nG92 X0\nG55", "G0 X1.", "rapid X11 Y0 Z0"},
         {fanuc, "G52 X3.\nG0 X10.", "G92 X10.\nG92 X0",
          "g92_offset X3 Y0 Z0 | g92_offset X13 Y0 Z0"},
         {fanuc, "G0 X10.\nG92 X0", "G92.1 X0", "g92_offset X0 Y0 Z0"},
         {haas, "", "G10 L2 P0 X4.", "g92_offset X4 Y0 Z0"}});
}

TEST(FanucCodes, TakeLocalShiftAndFramesBackAtTheEnd) {
  const std::string end = commands_of("G52 X1.\nG68 X0 Y0 R90.\nM30", fanuc, 2);
  EXPECT_TRUE(end.starts_with("program_map off | g92_offset X0 Y0 Z0 | work_offset")) << end;
}

TEST(FanucCodes, ShowTheFrameAsAMap) {
  check({{fanuc, "", "G68 X1. Y2. R90.", "program_map X = 0 -1 0 + 3 Y = 1 0 0 + 1 Z = 0 0 1 + 0"},
         {fanuc, "G68 X0 Y0 R30.", "G69", "program_map off"},
         {fanuc, "", "G51.1 X5.", "program_map X = -1 0 0 + 10 Y = 0 1 0 + 0 Z = 0 0 1 + 0"},
         {fanuc, "", "G51 X0 Y0 Z0 P2.", "program_map X = 2 0 0 + 0 Y = 0 2 0 + 0 Z = 0 0 2 + 0"},
         {haas, "", "G101 X0", "program_map X = -1 0 0 + 0 Y = 0 1 0 + 0 Z = 0 0 1 + 0"},
         {haas, "G101 X0", "G100 X0", "program_map off"},
         {fanuc, "G68 X0 Y0 R90.\nG91", "G68 X0 Y0 R90.",
          "program_map X = -1 0 0 + 0 Y = 0 -1 0 + 0 Z = 0 0 1 + 0"}});
}

TEST(FanucCodes, RefuseFramesWhereTheControlDoes) {
  for (const char* program :
       {"G68 X0 Y0 R30.\nG55", "G68 X0 Y0 R30.\nG18", "G68 X0 Y0 R30.\nG28 X0",
        "G68 X0 Y0 R30.\nG53 X0", "G68 X0 Y0 R30.\nG52 X1.", "G68 X0 Y0 R30.\nG92 X1.",
        "G68 X0 Y0 R30.\nG10 L2 P1 X1.", "G68 X0 Y0 R30.\nG51 X0 Y0 Z0 P2.",
        "G51 X0 Y0 Z0 P2.\nG51.1 X0", "G68 X0 Z0 R30.", "G51 X0 Y0 Z0 P0", "G51 X0 P2. I2.",
        "G91 G51.1 X0", "G51 X0 Y0 Z0 I2. J1. K1.\nG2 X10. I5. J0 F100",
        "G68 X0 Y0 R30.\nG69\nG91 X1."})
    EXPECT_EQ(kinds_of(program, fanuc, Severity::error), std::vector<std::string>{"frame_error"})
        << program;
  EXPECT_EQ(kinds_of("G68 X0 Y0 R30.\nG91 G28 Z0\nG90 G53 Z0", fanuc, Severity::error),
            std::vector<std::string>());
  for (const char* program : {"G68 X0 Y0", "G51 X0", "G51 X0 I2. J2."})
    EXPECT_EQ(kinds_of(program, fanuc, Severity::error), std::vector<std::string>{"word_missing"})
        << program;
  EXPECT_EQ(kinds_of("G51.1", fanuc, Severity::error),
            std::vector<std::string>{"axis_word_missing"});
  EXPECT_EQ(kinds_of("G1 G41 D1 X20. F100\nG68 X0 Y0 R30.", fanuc, Severity::error),
            std::vector<std::string>{"comp_illegal"});
}

TEST(FanucCodes, ApplyToolLengths) {
  check({{fanuc, "", "G43 H1 Z50.", "tool_offset X0 Y0 Z101 | rapid X0 Y0 Z50"},
         {fanuc, "", "G44 H1 Z50.", "tool_offset X0 Y0 Z-101 | rapid X0 Y0 Z50"},
         {fanuc, "", "G43 H1", "tool_offset X0 Y0 Z101 | rapid X0 Y0 Z0"},
         {haas, "", "G43 H1", "tool_offset X0 Y0 Z101"},
         {fanuc, "", "G91 G43 H1 Z5.", "tool_offset X0 Y0 Z101 | rapid X0 Y0 Z5"},
         {fanuc, "G43 H1 Z50.", "G49 Z60.", "tool_offset X0 Y0 Z0 | rapid X0 Y0 Z60"},
         {fanuc, "G43 H1 Z50.", "G43 H0 Z60.", "tool_offset X0 Y0 Z0 | rapid X0 Y0 Z60"},
         {fanuc, "G10 L11 P1 R-1.", "G43 H1 Z50.", "tool_offset X0 Y0 Z100 | rapid X0 Y0 Z50"},
         {fanuc, "G10 L10 P9 R7.", "G43 H9 Z50.", "tool_offset X0 Y0 Z7 | rapid X0 Y0 Z50"},
         {fanuc, "G91 G10 L10 P1 R7.\nG90", "G43 H1 Z50.",
          "tool_offset X0 Y0 Z108 | rapid X0 Y0 Z50"}});
  EXPECT_EQ(kinds_of("G43 H9 Z5.", fanuc, Severity::error),
            std::vector<std::string>{"tool_unknown"});
  EXPECT_EQ(kinds_of("G43 Z5.", fanuc, Severity::error), std::vector<std::string>{"word_missing"});
}

TEST(FanucCodes, ApplyToolRadii) {
  const char* line = "G1 G41 D1 X20. F100.\nY20.\nY40.";
  check({{fanuc, "G10 L12 P1 R3.", line,
          "feed_rate 100 | feed X17 Y0 Z0 | feed X17 Y20 Z0 | feed X17 Y40 Z0"}});
  // Diameters on a Haas, wear on top.
  EXPECT_EQ(commands_of(std::string("G10 L12 P1 R5.\nG10 L13 P1 R1.\n") + line, haas, 2),
            commands_of(std::string("G10 L12 P1 R2.5\nG10 L13 P1 R0.5\n") + line, fanuc, 2));
  EXPECT_EQ(kinds_of("G1 G41 X20. F100", fanuc, Severity::error),
            std::vector<std::string>{"word_missing"});
  EXPECT_EQ(kinds_of("G1 G41 D8 X20. F100", fanuc, Severity::error),
            std::vector<std::string>{"tool_unknown"});
}

TEST(FanucCodes, GoToMachinePositions) {
  const char* away = "G10 L2 P1 X100. Y100. Z100.\nG0 X1. Y2. Z3.";
  check({{fanuc, away, "G53 X5. Z0", "rapid X5 Y102 Z0"},
         {fanuc, "G1 F100 X1. Y0 Z0", "G53 X5.", "rapid X5 Y0 Z0"},
         {haas, "G1 F100 X1. Y0 Z0", "G53 X5.", "feed X5 Y0 Z0"},
         {fanuc, "G43 H1 Z50.", "G53 Z0", "rapid X0 Y0 Z-101 | tool_offset X0 Y0 Z0"},
         {haas, "G43 H1 Z50.", "G53 G0 Z0", "rapid X0 Y0 Z-101"},
         {fanuc, away, "G28 Z5.", "rapid X101 Y102 Z105 | rapid X101 Y102 Z0"},
         {fanuc, away, "G0 G91 G28 Z0", "rapid X101 Y102 Z103 | rapid X101 Y102 Z0"},
         {fanuc, away, "G91 G30 X0 Y0", "rapid X101 Y102 Z103 | rapid X10 Y20 Z103"},
         {fanuc, away, "G91 G30 P3 X0", "rapid X101 Y102 Z103 | rapid X11 Y102 Z103"},
         {fanuc, "G43 H1 Z50.", "G91 G28 Z0",
          "rapid X0 Y0 Z50 | rapid X0 Y0 Z-101 | tool_offset X0 Y0 Z0"},
         {fanuc, "G28 X5. Y6.", "G29 X1. Y1.", "rapid X5 Y6 Z0 | rapid X1 Y1 Z0"},
         {fanuc, away, "G27 X-100. Y-100.", "rapid X0 Y0 Z103"}});
  EXPECT_EQ(kinds_of("G91 G53 X0", fanuc, Severity::error), std::vector<std::string>{"g53_error"});
  for (const char* program : {"G29 X0", "G27 X5.", "G91 G30 P4 X0"})
    EXPECT_EQ(kinds_of(program, fanuc, Severity::error),
              std::vector<std::string>{"reference_error"})
        << program;
  EXPECT_EQ(kinds_of("G28", fanuc, Severity::error), std::vector<std::string>{"axis_word_missing"});
  EXPECT_EQ(kinds_of("G43 H1 Z50.\nG91 G28 Z0\nG90 Z50.", fanuc, Severity::warning),
            std::vector<std::string>{"control_setting"});
  EXPECT_EQ(kinds_of("G43 H1 Z50.\nG91 G28 Z0\nG90 G43 H1 Z50.", fanuc, Severity::warning),
            std::vector<std::string>());
}

TEST(FanucCodes, DwellAndSkip) {
  check({{fanuc, "", "G4 X1.5", "dwell 1.5"},
         {fanuc, "", "G4 P1500.", "dwell 1.5"},
         {haas, "", "G4 P1.5", "dwell 1.5"},
         {fanuc, "", "G31 X5. F100", "feed_rate 100 | probe toward X5 Y0 Z0"}});
  EXPECT_EQ(kinds_of("G4", fanuc, Severity::error), std::vector<std::string>{"word_missing"});
  EXPECT_EQ(kinds_of("G4 P1.5", fanuc, Severity::error), std::vector<std::string>{"dwell_time"});
  EXPECT_EQ(kinds_of("G4 X-1.", fanuc, Severity::error), std::vector<std::string>{"dwell_time"});
}

TEST(FanucCodes, ControlThePath) {
  check({{fanuc, "", "G61", "path exact_stop"},
         {fanuc, "G61", "G62", "path continuous 0"},
         {fanuc, "G61", "G63", "path continuous 0"},
         {fanuc, "G61", "G64", "path continuous 0"},
         {fanuc, "", "M19", "orient 0 direction 0"}});
}

TEST(FanucCodes, AreAcceptedWhenTheyMoveNothing) {
  for (const char* line : {"G9", "G5.1 Q1", "G8 P1", "G13.1", "G22 X1. Y1. Z1. I0 J0 K0", "G23",
                           "G25", "G26", "G113", "G40.1"}) {
    EXPECT_EQ(kinds_of(line, fanuc, Severity::info), std::vector<std::string>{"code_accepted"})
        << line;
    EXPECT_EQ(kinds_of(line, fanuc, Severity::error), std::vector<std::string>()) << line;
  }
  for (const char* line : {"G187 P3 E0.1", "G103", "M31", "M33", "M88", "M89", "M10", "M11", "M36",
                           "M41", "M80", "M85"})
    EXPECT_EQ(kinds_of(line, haas, Severity::info), std::vector<std::string>{"code_accepted"})
        << line;
}

TEST(FanucCodes, AreRefusedWhenTheyMoveAndAreNotModelled) {
  for (const char* line : {"G5 X1.", "G6.2", "G7.1 C10.", "G107", "G12.1", "G112",
                           "G68.2 X0 Y0 Z0 I0 J0 K0", "G43.4 H1", "G43.5 H1", "G47", "G53.1",
                           "G51.2", "G45 X1.", "G2.1", "G68 X0 Y0 Z0 I0 J0 K1. R30."})
    EXPECT_EQ(kinds_of(line, fanuc, Severity::error), std::vector<std::string>{"unsupported_code"})
        << line;
  for (const char* line : {"G47 P0", "G150", "G234", "G254", "G143"})
    EXPECT_EQ(kinds_of(line, haas, Severity::error), std::vector<std::string>{"unsupported_code"})
        << line;
  EXPECT_EQ(kinds_of("G68 X0 Z0 R30.", fanuc_lathe, Severity::error),
            std::vector<std::string>{"unsupported_code"});
}

TEST(FanucCodes, OfTheMachineBuilderAreListed) {
  check({{fanuc, "", "M123 P5.", "user_code M123 P5"},
         {fanuc, "", "M21 M22", "user_code M21 | user_code M22"},
         {haas, "", "M59 P3.", "user_code M59 P3"},
         {fanuc, "", "G10 L50\nN1234 P1 R100\nG11\nG0 X1.", "user_code G10 | rapid X1 Y0 Z0"}});
}

TEST(FanucCodes, SwitchTheModeBesideACodeThatTakesTheAxisWords) {
  check({{fanuc, "", "G0 G28 G91 Z0", "rapid X0 Y0 Z0 | rapid X0 Y0 Z0"},
         {fanuc, "G0 G52 X1.", "X5.", "rapid X6 Y0 Z0"},
         {fanuc, "F100\nG1 G52 X1.", "X5.", "feed X6 Y0 Z0"}});
}

TEST(FanucCodes, OnALatheXIsADiameterAndTChangesToolAndOffset) {
  check({{fanuc_lathe, "", "G0 X20. Z5.", "rapid X10 Y0 Z5"},
         {fanuc_lathe, "", "T0102", "select_tool 1 | change_tool 1 | tool_offset X20 Y0 Z102"},
         {fanuc_lathe, "T0102", "T0100", "tool_offset X0 Y0 Z0"},
         {fanuc_lathe, "G10 P1 X0.2 Z-0.1", "T0101",
          "select_tool 1 | change_tool 1 | tool_offset X10.1 Y0 Z100.9"},
         {fanuc_lathe, "G10 P10001 X40. Z50. R0.4 Q3", "T0101",
          "select_tool 1 | change_tool 1 | tool_offset X20 Y0 Z50"},
         {fanuc_lathe, "G10 L2 P2 X10. Z-5.", "G55", "work_offset 2 X5 Y0 Z-5"},
         {fanuc_lathe, "G0 X20. Z5.", "G28 X30.", "rapid X15 Y0 Z5 | rapid X0 Y0 Z5"}});
  EXPECT_EQ(kinds_of("T0901", fanuc_lathe, Severity::error),
            std::vector<std::string>{"tool_unknown"});
  EXPECT_EQ(kinds_of("T0109", fanuc_lathe, Severity::error),
            std::vector<std::string>{"tool_unknown"});
}

TEST(FanucCodes, KeepTheirOffsetsInTheParameterFile) {
  Setting setting = fanuc;
  setting.parameters.values[5221] = 7;
  setting.parameters.values[14021] = 9;
  SourceMap sources;
  const Ran ran =
      run_program(sources, "G91 G10 L2 P1 X1.\nG90 G10 L2 P2 Y3.\nG10 L20 P3 Z4.\nM30\n", setting);
  EXPECT_EQ(ran.parameters.values.at(5221), 8);
  EXPECT_EQ(ran.parameters.values.at(5242), 3);
  EXPECT_EQ(ran.parameters.values.at(14021), 9);
  EXPECT_EQ(ran.parameters.values.at(14043), 4);
  EXPECT_EQ(ran.parameters.values.at(5183), 30);
}

/// What is told about a code that the control does not have.
std::string unknown_on(const Setting& setting, const std::string& code) {
  return commands_of(code, setting, 0);
}

TEST(UnknownCodes, AreToldWithTheControlThatHasThem) {
  const auto told = [](const std::string& code, const char* who) {
    return "error unknown_code: " + code + " is not a code of this control; " + who + " | ";
  };
  EXPECT_EQ(unknown_on(fanuc, "G96"),
            told("G96", "Fanuc's turning centres have it (--dialect fanuc --lathe)"));
  EXPECT_EQ(unknown_on(fanuc_lathe, "G51.1"),
            told("G51.1", "Fanuc's machining centres have it (--dialect fanuc)"));
  EXPECT_EQ(unknown_on(fanuc, "G154"),
            told("G154", "Haas's machining centres have it (--dialect haas)"));
  EXPECT_EQ(unknown_on(control(Dialect::linuxcnc), "G68"),
            told("G68", "Fanuc's machining centres have it (--dialect fanuc)"));
  EXPECT_EQ(unknown_on(fanuc, "G59.3"), told("G59.3", "LinuxCNC has it (--dialect linuxcnc)"));
  EXPECT_EQ(unknown_on(fanuc, "G299"), told("G299", "check the number"));
}

}  // namespace
}  // namespace aircut::test
