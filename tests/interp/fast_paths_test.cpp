// What goes past the code table gives the same as what goes through it: every program of the tests,
// and programs by chance, with and without the fast paths.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "interp/run_program.h"
#include "peer/generator.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

/// Everything that a run says.
std::string told_by(const std::string& program, Setting setting, bool fast_paths) {
  setting.options.fast_paths = fast_paths;
  setting.options.limits.max_blocks = 20'000;
  for (int n = 1; n <= 40; ++n) setting.parameters.values[n] = 0;  // then their ends are told too
  SourceMap sources;
  const Ran ran = run_program(sources, program, setting);
  std::string all;
  for (const canon::Command& command : ran.commands) all += canon::to_json(command) + "\n";
  for (const Diagnostic& d : ran.diagnostics.list()) all += format_human(d, {}) + "\n";
  for (const auto& [n, value] : ran.parameters.values)
    all += "#" + std::to_string(n) + "=" + shortest(value) + "\n";
  return all + std::to_string(ran.statistics.blocks) + " blocks, " +
         std::to_string(ran.statistics.lines) + " lines";
}

void expect_same(const std::string& program, const Setting& setting = {}) {
  EXPECT_EQ(told_by(program, setting, true), told_by(program, setting, false)) << program;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(FastPaths, GiveTheSameForTheProgramsOfTheTests) {
  int count = 0;
  for (const char* folder : {"tests/interp_programs/programs", "tests/interp/errors"})
    for (const auto& entry :
         fs::recursive_directory_iterator(AIRCUT_SOURCE_DIR "/" + std::string(folder))) {
      if (entry.path().extension() != ".ngc") continue;
      ++count;
      expect_same(text_of(entry.path()));
    }
  EXPECT_GT(count, 100);
}

TEST(FastPaths, GiveTheSameForProgramsByChance) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) expect_same(generate_program(seed));
}

// Lines that the fast paths take, among lines that change the state they look at.
TEST(FastPaths, GiveTheSameForLinesInAnyState) {
  const std::vector<std::string> lines = {"G0 X1 Y2",
                                          "G1 X4 Y1",
                                          "Z3",
                                          "X#1",
                                          "Y[#2*3]",
                                          "G1 X[1/#1]",
                                          "A10",
                                          "G2 X5 Y5 I2 J2",
                                          "G3 X1 Y0 I-2",
                                          "G2 X1 Z1 R5",
                                          "G2 I1",
                                          "G3 X3 Y3 Z1 A5 J2 F50",
                                          "G3 X0 Y0 R-8",
                                          "G2 X4 R[#1+3]",
                                          "G2 X#1 I[#2/#1]",
                                          "X2 I1",
                                          "I-3",
                                          "K1",
                                          "R2",
                                          "X3 R2 I1",
                                          "G3 X1 Z2 I1 K1",
                                          "G2 Y5 Z5 K3",
                                          "G2 X3 P2 I1.5",
                                          "G2 X900 Y5 I1",
                                          "G2 U1 I1",
                                          "G2.1 X1",
                                          "G2",
                                          "G1 X2 I1",
                                          "G1 X5 F30",
                                          "X1 F0",
                                          "Y6 F-1",
                                          "F10 Z2",
                                          "G0 X3 F[#1*9]",
                                          "G93 G1 X2 F3",
                                          "X7 R9",
                                          "G17",
                                          "G18",
                                          "G19",
                                          "G20",
                                          "G21",
                                          "G90",
                                          "G91",
                                          "G90.1",
                                          "G91.1",
                                          "G93 F2",
                                          "G94 F100",
                                          "G95 F.1",
                                          "G7",
                                          "G8",
                                          "F0",
                                          "F200",
                                          "G92 X1 Y2",
                                          "G92.1",
                                          "G10 L2 P1 R30",
                                          "G10 L2 P1 R0 X3",
                                          "G54",
                                          "G55",
                                          "G41.1 D2",
                                          "G40",
                                          "G81 Z-3 R2",
                                          "G80",
                                          "G5.2 X1 Y1 P1 L3",
                                          "G5.3",
                                          "G5 I1 J1 P-1 Q1 X2 Y2",
                                          "#1=[#1+1]",
                                          "#1=#2 #2=[#1*2]",
                                          "#<a>=#1",
                                          "#<_b>=[#<a>+1]",
                                          "#5399=#<_b>",
                                          "#<_x>=1",
                                          "#[#1]=2",
                                          "#31=[1/#1]",
                                          "#1=7 (note)",
                                          "#5421=1",
                                          "G43.1 Z5",
                                          "G53 G0 X0",
                                          "N7 X2",
                                          "/X3",
                                          "X1 (note)",
                                          "G1",
                                          "G0",
                                          "U1",
                                          "M3 S100",
                                          "G80 X1",
                                          "G38.2 X9",
                                          "G33 Z1 K1",
                                          "o1 ",
                                          "M70",
                                          "M72",
                                          "G28",
                                          "G4 P0"};
  std::mt19937 random(11);
  for (int round = 0; round < 600; ++round) {
    std::string program;
    int labels = 1;
    for (int i = 0; i < 25; ++i) {
      std::string line = lines[random() % lines.size()];
      if (line.starts_with("o1 ")) {  // each construct has a label of its own
        const std::string label = "o" + std::to_string(labels++);
        line = label + " if [#1 gt 2]\nX1\n" + label + " endif";
      }
      program += line + "\n";
    }
    if (round % 3 == 0)
      program = "#9=0\no900 while [#9 lt 3]\n" + program + "#9=[#9+1]\no900 endwhile\n";
    Setting setting;
    if (round % 4 == 1)
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) setting.options.axes.add(axis);
    if (round % 6 == 2) {  // the set-up gives F or G3 another meaning
      interp::Remap remap;
      remap.letter = round % 12 == 2 ? 'F' : 'G';
      remap.code = remap.letter == 'F' ? 0 : 30;
      remap.modal_group = 1;
      remap.python = "something";
      remap.name = remap.letter == 'F' ? "F" : "G3";
      setting.options.remaps.push_back(remap);
    }
    expect_same("F100\n" + program + "M2\n", setting);
  }
}

// The same for lines of Fanuc's and Haas' dialects, with a macro behind every move now and then.
TEST(FastPaths, GiveTheSameForLinesOfOtherControls) {
  const std::vector<std::string> lines = {"G0 X1. Y2.",
                                          "G1 X4. Y1.",
                                          "Z3.",
                                          "X1",
                                          "X.5 F30.",
                                          "G1 Y7. F50",
                                          "X#100",
                                          "G2 X5. R5.",
                                          "G3 I2.",
                                          "X2. I1. J1.",
                                          "G2 X9. Y9. I1.",
                                          "U1.",
                                          "W-2. X1.",
                                          "G17",
                                          "G18",
                                          "G90",
                                          "G91",
                                          "G20",
                                          "G21",
                                          "G68 X0 Y0 R30.",
                                          "G69",
                                          "G51.1 X0",
                                          "G50.1 X0",
                                          "G51 X0 Y0 P2.",
                                          "G50",
                                          "G52 X1.",
                                          "G43 H1 Z5.",
                                          "G49",
                                          "G28 Z0",
                                          "G66 P9100 A5.",
                                          "G67",
                                          "G65 P9100 A1.",
                                          "G81 Z-3. R2. F20.",
                                          "G80",
                                          "#100=#4001",
                                          "#101=#4124",
                                          "#100=#5041",
                                          "X1. X2.",
                                          "N30 X3.",
                                          "G40",
                                          "G90 X3. Z-4. F9.",
                                          "G4 P100",
                                          "M3 S100",
                                          "G94",
                                          "G95 F.1"};
  std::mt19937 random(12);
  for (int round = 0; round < 400; ++round) {
    std::string program = "O1\nF100.\n";
    for (int i = 0; i < 25; ++i) program += lines[random() % lines.size()] + "\n";
    Setting setting;
    setting.options.dialect = round % 3 == 0 ? interp::Dialect::haas : interp::Dialect::fanuc;
    setting.options.lathe = round % 4 == 0;
    if (round % 5 == 1)
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) setting.options.axes.add(axis);
    expect_same(program + "M30\nO9100\nG91\nG1 Z#1\nX1.\nG90\nM99\n", setting);
  }
}

TEST(FastPaths, CallTheModalMacroBehindAPlainMove) {
  SourceMap sources;
  Setting setting;
  setting.options.dialect = interp::Dialect::fanuc;
  const Ran ran = run_program(
      sources, "O1\nG66 P9100 A5.\nG0 X1.\nG67\nX2.\nM30\nO9100\nG0 Z#1\nM99\n", setting);
  ASSERT_GE(ran.texts.size(), 3u);
  EXPECT_EQ(ran.texts[0], "rapid X1 Y0 Z0");
  EXPECT_EQ(ran.texts[1], "rapid X1 Y0 Z5");
  EXPECT_EQ(ran.texts[2], "rapid X2 Y0 Z5");
}

}  // namespace
}  // namespace aircut::test
