// The program as a user calls it: exit codes, messages, files.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "cli/program.h"
#include "interp/interp.h"
#include "sim/sim.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

class Cli : public Program {};

// ---- the main job ----------------------------------------------------------------------------

// Number of the first line of a shipped program that holds `text`.
std::string line_of(const std::string& program, const std::string& text) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/programs/" + program);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find(text) != std::string::npos) return std::to_string(number);
  }
  return "none";
}

TEST_F(Cli, NamesTheHolderThatARapidDrivesIntoTheVise) {
  const std::string line = line_of("holder-into-vise.ngc", "G0 X75 Y60");
  const Outcome r =
      aircut("run programs/holder-into-vise.ngc -m mill3 --frames finding --size 320x200 -o " +
             path("out"));
  EXPECT_EQ(r.code, 1) << r.out << r.err;
  EXPECT_TRUE(r.says("error[collision]: tool holder `T1/holder")) << r.out;
  EXPECT_TRUE(r.says("vise/fixed-jaw")) << r.out;
  EXPECT_TRUE(r.says("holder-into-vise.ngc:" + line + ":1")) << r.out;
  EXPECT_TRUE(r.says("G0 X75 Y60")) << r.out;
  EXPECT_TRUE(fs::exists(path("out/frames/collision-L" + line + ".png")));
  EXPECT_TRUE(fs::exists(path("out/sheet.png")));
  const std::string json = text_of(path("out/result.json"));
  EXPECT_NE(json.find("\"verdict\": \"fail\""), std::string::npos);
  EXPECT_NE(json.find("\"picture\": \"frames/collision-L" + line + ".png\""), std::string::npos);
}

TEST_F(Cli, PassesTheSameProgramWithTheViseMovedAway) {
  const Outcome r =
      aircut("run programs/holder-into-vise.ngc -m mill3 --setup programs/vise-moved.setup.toml");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_TRUE(r.says("verdict: pass"));
  EXPECT_TRUE(r.says("100 % proven clear"));
}

TEST_F(Cli, RunsThePartProgramsClean) {
  for (const char* job : {"bracket.ngc -m mill3", "flange.ngc -m mill3",
                          "side-cover-freecad.ngc -m mill3", "ox-cover.ngc -m ox-glide-crossed"}) {
    const Outcome r = aircut(std::string("run programs/") + job);
    EXPECT_EQ(r.code, 0) << job << "\n" << r.out << r.err;
  }
}

TEST_F(Cli, FindsOverTravelInsideAnArc) {
  const Outcome r = aircut("run programs/overtravel.ngc -m mill3");
  EXPECT_EQ(r.code, 1) << r.out << r.err;
  EXPECT_TRUE(r.says("error[overtravel]")) << r.out;
}

TEST_F(Cli, FindsAPointOnThePathThatCantBeReached) {
  const Outcome r = aircut("run programs/ox-unreachable.ngc -m ox-glide-crossed");
  EXPECT_EQ(r.code, 1) << r.out << r.err;
  EXPECT_TRUE(r.says("error[unreachable]")) << r.out;
  EXPECT_TRUE(r.says("not checked:")) << r.out;
}

TEST_F(Cli, GivesTheSameBytesTwice) {
  const std::string job =
      "run programs/holder-into-vise.ngc -m mill3 --frames count=3 --frames finding "
      "--size 320x200 -o ";
  const Outcome a = aircut(job + path("a")), b = aircut(job + path("b"));
  ASSERT_EQ(a.code, 1) << a.err;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path("a")))
    if (entry.is_regular_file()) {
      ++files;
      const fs::path other = path("b") / fs::relative(entry.path(), path("a"));
      EXPECT_EQ(text_of(entry.path()), text_of(other)) << entry.path();
    }
  EXPECT_GE(files, 7);
}

TEST_F(Cli, WritesAJointLogThatSatisfiesTheMechanismAtEveryRow) {
  const Outcome r =
      aircut("run programs/ox-cover.ngc -m ox-glide-crossed --frames none -o " + path("out"));
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  std::ifstream log(path("out/joints.csv"));
  std::string line;
  std::map<std::string, std::size_t> column;
  // From kinematics: rod 1 on the guide at z = -d, rod 2 at z = +d.
  const double l1 = 302, l2 = 432, p1 = 55, p2 = 65, d = 74;
  double tool_length = 0, worst = 0;
  std::size_t rows = 0;
  int length_changes = 0;
  while (std::getline(log, line)) {
    if (line.starts_with("#")) continue;
    std::stringstream cells(line);
    std::vector<std::string> cell;
    for (std::string text; std::getline(cells, text, ',');) cell.push_back(text);
    if (column.empty()) {
      for (std::size_t i = 0; i < cell.size(); ++i) column[cell[i]] = i;
      for (const char* name : {"q0", "q1", "q2", "x", "y", "z"})
        ASSERT_TRUE(column.contains(name)) << line;
      continue;
    }
    const auto at = [&](const char* name) { return std::stod(cell.at(column.at(name))); };
    ++rows;
    // The tip is the platform point less the tool length, which must be one number per offset in
    // force; it is found from the first equation and tested in the second.
    const double s1 = at("q0"), s2 = at("q1"), x = at("x"), z_tip = at("z");
    const double z1 = -d - std::sqrt(l1 * l1 - std::pow(x - p1 - s1, 2));
    const double length = z1 - z_tip;
    if (std::abs(length - tool_length) > 1e-3) {
      tool_length = std::round(length * 1e6) / 1e6;
      ++length_changes;
    }
    const double z = z_tip + tool_length;
    worst = std::max({worst, std::abs(std::hypot(x - p1 - s1, z + d) - l1),
                      std::abs(std::hypot(x + p2 - s2, z - d) - l2), std::abs(at("y") - at("q2"))});
  }
  EXPECT_GT(rows, 1000u);
  EXPECT_LT(worst, 1e-6);
  // Each G43 and G49 of the program may change the length; a drift must not pass for one.
  const std::string program = text_of(AIRCUT_SOURCE_DIR "/programs/ox-cover.ngc");
  int allowed = 1;
  for (std::size_t at = 0; (at = program.find("G4", at)) != std::string::npos; ++at)
    allowed += program[at + 2] == '3' || program[at + 2] == '9' ? 1 : 0;
  EXPECT_LE(length_changes, allowed);
}

// ---- other commands --------------------------------------------------------------------------

TEST_F(Cli, ReadsAProgramFromStandardInput) {
  const Outcome r = aircut("trace -", "G21\nG0 X1\nM2\n");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(r.says("rapid X1 Y0 Z0")) << r.out;
  const Outcome json = aircut("trace - --format jsonl", "G21\nG0 X1\nM2\n");
  EXPECT_TRUE(json.says("\"x_mm\":1")) << json.out;
  const Outcome peer = aircut("trace - --format rs274", "G21\nG0 X1\nM2\n");
  EXPECT_TRUE(peer.says("STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000")) << peer.out;
}

TEST_F(Cli, ChecksManyProgramsAndReportsEachError) {
  put("a.ngc", "G21\nG1 X10\nM2\n");
  put("b.ngc", "G21\nG0 X1\nM2\n");
  const Outcome r = aircut("check " + path("a.ngc") + " " + path("b.ngc") + " --format gcc");
  EXPECT_EQ(r.code, 1);
  EXPECT_TRUE(r.says("a.ngc:2:1: error: ")) << r.out;
  EXPECT_FALSE(r.says("b.ngc"));
}

TEST_F(Cli, ExplainsEveryKind) {
  const Outcome list = aircut("explain --list");
  EXPECT_EQ(list.code, 0);
  for (const auto* kinds : {&interp::error_kinds(), &sim::finding_kinds()})
    for (const KindText& row : *kinds) EXPECT_TRUE(list.says(row.kind)) << row.kind;
  EXPECT_TRUE(aircut("explain collision").says("contact tolerance"));
  const Outcome wrong = aircut("explain colision");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(wrong.says("Did you mean 'collision'?"));
}

TEST_F(Cli, DescribesChecksAndPicturesTheMachines) {
  for (const char* machine : {"mill3", "ox-glide-crossed"}) {
    const Outcome check = aircut(std::string("machine check -m ") + machine);
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    EXPECT_EQ(aircut(std::string("machine info -m ") + machine).code, 0);
    const std::string png = path(std::string(machine) + ".png");
    EXPECT_EQ(
        aircut(std::string("machine render -m ") + machine + " --size 320x200 -o " + png).code, 0);
    EXPECT_TRUE(text_of(png).starts_with("\x89PNG"));
  }
}

// ---- bad input -------------------------------------------------------------------------------

TEST_F(Cli, RefusesInputsThatCantBeRead) {
  struct Case {
    std::string arguments, message;
  };
  put("empty.ngc", "");
  put("binary.ngc", std::string("\x7f"
                                "ELF\0\1\2\3\0\0\xff\xfe",
                                12));
  for (const Case& c : std::vector<Case>{
           {"run nowhere.ngc -m mill3", "No such file"},
           {"run programs -m mill3", "it is a folder"},
           {"run programs/bracket.ngc -m mil3", "Did you mean 'mill3'?"},
           {"run programs/bracket.ngc -m mill3 --tools nowhere.toml", "No such file"},
           {"run programs/bracket.ngc -m mill3 --setup nowhere.toml", "No such file"},
           {"run programs/bracket.ngc -m mill3 --fraems count=3", "Did you mean '--frames'?"},
           {"run programs/bracket.ngc -m mill3 --frames cuont=3 -o x", "Did you mean 'count'?"},
           {"run programs/bracket.ngc -m mill3 --frames count=3", "needs -o"},
           {"run programs/bracket.ngc -m mill3 --camera isso -o x", "iso"},
           {"run programs/bracket.ngc -m mill3 --set 5=3", "#100=5"},
           {"run programs/bracket.ngc -m mill3 --size 3", "1280x800"},
           {"rnu programs/bracket.ngc", "Did you mean 'run'?"},
           {"run programs/bracket.ngc", "--machine MACHINE is missing: shipped name"},
           {"run programs/bracket.ngc -m mill3 -m mill3", "is given 2 times"},
           {"run programs/bracket.ngc -m", "the value is missing"},
           {"run programs/bracket.ngc -m mill3 --near -3", "'-3': write a number from 0 to 1000"},
           {"run programs/bracket.ngc -m mill3 --max-blocks x", "'x': write a number"},
           {"run programs/bracket.ngc -m mill3 --format jsn", "Did you mean 'json'?"},
           {"run programs/bracket.ngc -m mill3 --force=maybe", "this option takes no value"},
           {"run programs/bracket.ngc more -m mill3", "'more' is one argument too many"},
           {"workspace -m mill3 --tool -1", "write a number of 0 or more"},
           {"kin fk", "see aircut kin fk --help"},
           {"machine foo", "There are check, info"},
           {"", "name a command: run, job, check"},
       }) {
    const Outcome r = aircut(c.arguments);
    EXPECT_EQ(r.code, 2) << c.arguments << "\n" << r.out << r.err;
    EXPECT_TRUE(r.says(c.message)) << c.arguments << "\n" << r.err;
    EXPECT_TRUE(r.out.empty()) << r.out;
  }
  EXPECT_FALSE(fs::exists(fs::path(AIRCUT_SOURCE_DIR) / "x"));
}

TEST_F(Cli, RefusesProgramsThatAreNotPrograms) {
  put("empty.ngc", "");
  put("binary.ngc", std::string("\x7f"
                                "ELF\0\1\2\3\0\0\xff\xfe",
                                12));
  for (const char* name : {"empty.ngc", "binary.ngc"}) {
    const Outcome r = aircut("run " + path(name) + " -m mill3");
    EXPECT_EQ(r.code, 1) << name << r.out << r.err;
    EXPECT_TRUE(r.says("error[")) << r.out;
  }
}

TEST_F(Cli, IsUnknownWhenALoopDoesNotEnd) {
  put("endless.ngc", "G21\no1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n");
  const std::string limit = path("endless.ngc") + " --max-blocks 5000";
  for (const std::string& job :
       {"run " + limit + " -m mill3", "check " + limit, "trace " + limit}) {
    const Outcome r = aircut(job);
    EXPECT_EQ(r.code, 2) << job << r.out << r.err;
    EXPECT_TRUE(r.says("[loop_limit]")) << r.out << r.err;
    EXPECT_TRUE(r.says("endless.ngc:2:1")) << r.out << r.err;
  }
}

// `timeout` sends its signal to the program and to the program's group: it comes twice.
TEST_F(Cli, FinishesItsFilesWhenItIsAskedTwiceToStop) {
  put("endless.ngc", "G21\no1 while [1]\nG1 X1 F100\nG1 X0\no1 endwhile\nM2\n");
  for (const auto& [signal, expected] : {std::pair("TERM", 143), std::pair("INT", 130)}) {
    const std::string folder = path(signal);
    const std::string command =
        "cd " AIRCUT_SOURCE_DIR " && bash -c '" AIRCUT_BINARY_DIR "/bin/aircut run " +
        path("endless.ngc") + " -m mill3 --frames none -o " + folder + " >" + path("stdout") +
        " 2>&1 & while [ ! -e " + folder + " ]; do sleep 0.05; done; sleep 0.3; kill -" + signal +
        " $!; sleep 0.01; kill -" + signal + " $!; wait $!'";
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), expected) << text_of(path("stdout"));
    EXPECT_TRUE(text_of(path("stdout")).find("was interrupted") != std::string::npos)
        << text_of(path("stdout"));
    EXPECT_TRUE(fs::exists(folder + "/result.json"));
    for (const auto& file : fs::directory_iterator(folder))
      EXPECT_EQ(file.path().string().find("partial"), std::string::npos) << file.path();
  }
}

TEST_F(Cli, RefusesToWriteWhereItMustNot) {
  fs::create_directory(path("full"));
  put("full/mine.txt", "keep me");
  const std::string job = "run programs/ox-unreachable.ngc -m ox-glide-crossed --frames none -o ";
  const Outcome full = aircut(job + path("full"));
  EXPECT_EQ(full.code, 2);
  EXPECT_TRUE(full.says("--force")) << full.err;
  EXPECT_FALSE(fs::exists(path("full/joints.csv")));
  EXPECT_EQ(aircut(job + path("full") + " --force").code, 1);
  EXPECT_TRUE(fs::exists(path("full/result.json")));
  EXPECT_EQ(text_of(path("full/mine.txt")), "keep me");

  put("file", "");
  const Outcome file = aircut(job + path("file"));
  EXPECT_EQ(file.code, 2);
  EXPECT_TRUE(file.says("not a folder")) << file.err;
  const Outcome nowhere = aircut(job + "/proc/nowhere/out");
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_TRUE(nowhere.says("can't write")) << nowhere.err;
}

TEST_F(Cli, ReplacesNoFileByALogWithoutBeingTold) {
  put("mine.ngc", text_of(AIRCUT_SOURCE_DIR "/programs/overtravel.ngc"));
  const std::string job = "run " + path("mine.ngc") + " -m mill3 -q --log ";
  EXPECT_EQ(aircut(job + path("mine.ngc")).code, 2);
  EXPECT_EQ(text_of(path("mine.ngc")), text_of(AIRCUT_SOURCE_DIR "/programs/overtravel.ngc"));
  EXPECT_EQ(aircut(job + "/dev/full --force").code, 2);
  EXPECT_EQ(aircut(job + "-").code, 2);
  EXPECT_EQ(aircut(job + path("joints.csv")).code, 1);
}

TEST_F(Cli, IsNotAPassWhenStandardOutputIsFull) {
  const int status = std::system("cd " AIRCUT_SOURCE_DIR " && " AIRCUT_BINARY_DIR
                                 "/bin/aircut trace programs/flange.ngc >/dev/full 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const int info = std::system("cd " AIRCUT_SOURCE_DIR " && " AIRCUT_BINARY_DIR
                               "/bin/aircut machine info -m mill3 >/dev/full 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(info), 2);
}

TEST_F(Cli, IsUnknownWithAnOpenMesh) {
  // The box of tests/support/box_machine.h would do; here a shipped machine loses triangles.
  fs::copy(AIRCUT_SOURCE_DIR "/machines/mill3", path("open"), fs::copy_options::recursive);
  std::string stl = text_of(path("open/meshes/vise-fixed-jaw.stl"));
  const auto triangles = static_cast<std::uint32_t>((stl.size() - 84) / 50 - 2);
  for (int i = 0; i < 4; ++i)
    stl[80 + static_cast<std::size_t>(i)] = static_cast<char>(triangles >> 8 * i & 255);
  stl.resize(84 + 50 * std::size_t{triangles});
  put("open/meshes/vise-fixed-jaw.stl", stl);
  const Outcome r = aircut("run programs/bracket.ngc -m " + path("open"));
  EXPECT_EQ(r.code, 2) << r.out << r.err;
  EXPECT_TRUE(r.says("[mesh_defect]")) << r.out;
}

TEST_F(Cli, WritesNothingHalfWhenAnInputIsWrong) {
  const Outcome r = aircut("run nowhere.ngc -m mill3 -o " + path("out"));
  EXPECT_EQ(r.code, 2);
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Cli, EscapesWhatATextCouldDoToATerminal) {
  put("evil.ngc", "G21\n(\x1b[31mred) G1 Xoops\nM2\n");
  const Outcome r = aircut("check " + path("evil.ngc") + " --color never");
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.out.find('\x1b'), std::string::npos);
  EXPECT_TRUE(r.says("^[[31m")) << r.out;
}

TEST_F(Cli, AnswersHelpAndVersion) {
  EXPECT_EQ(aircut("--version").out.rfind("aircut ", 0), 0u);
  EXPECT_EQ(aircut("--help").code, 0);
  EXPECT_TRUE(aircut("run --help").says("aircut run programs/bracket.ngc -m mill3 -o out"));
  EXPECT_TRUE(aircut("help run").says("--frames"));
}

}  // namespace
}  // namespace aircut
