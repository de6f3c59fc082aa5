// `aircut kin`: rows in, rows out; the published numbers come through the command line.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "kin_program.h"

namespace aircut {
namespace {

struct VectorFile {
  std::string file, machine;
  std::vector<std::string> pose, joints;
  bool jacobian;  ///< has jacobian_ds_dxz
};

std::vector<VectorFile> vector_files() {
  const std::vector<std::string> glide = {"s1", "s2", "s3"};
  const std::vector<std::string> five = {"x", "y", "z", "A", "B"};
  const std::vector<std::string> arm5 = {"t1", "t2", "t3", "t4", "t5"};
  return {{"ox_glide_crossed", "ox-glide-crossed", {"x", "y", "z"}, glide, true},
          {"ox_glide_extended", "ox-glide-extended", {"x", "y", "z"}, glide, true},
          {"robot_horizontal_t4_blocked", "lola50-horizontal", five, arm5, false},
          {"robot_vertical_t6_blocked", "lola50-vertical", five, arm5, false},
          {"robot_6r",
           "lola50-6r",
           {"x", "y", "z", "A", "B", "C"},
           {"t1", "t2", "t3", "t4", "t5", "t6"},
           false}};
}

// A row per vector.
std::string table(const nlohmann::json& file, const char* part,
                  const std::vector<std::string>& names) {
  std::string text;
  for (const auto& v : file.at("vectors"))
    for (std::size_t i = 0; i < names.size(); ++i)
      text += v.at(part).at(names[i]).dump() + (i + 1 < names.size() ? " " : "\n");
  return text;
}

TEST_F(Kin, GivesTheNumbersOfTheVectors) {
  for (const VectorFile& f : vector_files()) {
    SCOPED_TRACE(f.file);
    std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/" + f.file + ".json");
    const auto file = nlohmann::json::parse(in);
    const std::string poses = table(file, "pose", f.pose);
    const std::string joints = table(file, "joints", f.joints);
    const auto compare = [&](const std::string& got, const std::string& wanted, double tolerance) {
      const auto a = rows_of(got), b = rows_of(wanted);
      ASSERT_EQ(a.size(), b.size()) << got;
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].size(), b[i].size()) << "row " << i << "\n" << got;
        for (std::size_t k = 0; k < a[i].size(); ++k) {
          const bool angle = f.machine.starts_with("lola");
          const double difference = a[i][k] - b[i][k];
          EXPECT_NEAR(angle ? std::remainder(difference, 360) : difference, 0, tolerance)
              << "row " << i << ", number " << k;
        }
      }
    };
    const Outcome ik = kin("ik -m " + f.machine, poses);
    compare(ik.out, joints, f.jacobian ? 1e-6 : 1e-5);
    const Outcome fk = kin("fk -m " + f.machine, joints);
    EXPECT_EQ(fk.code, 0) << fk.out;
    compare(fk.out, poses, 1e-6);
    if (!f.jacobian) continue;
    EXPECT_EQ(ik.code, 0) << ik.out;
    const Outcome jac = kin("jac -m " + f.machine, poses);
    EXPECT_EQ(jac.code, 0);
    const auto rows = rows_of(jac.out);
    ASSERT_EQ(rows.size(), file.at("vectors").size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].size(), 9u);
      const auto& wanted = file.at("vectors")[i].at("jacobian_ds_dxz");
      for (const std::size_t joint : {0u, 1u}) {
        EXPECT_NEAR(rows[i][3 * joint], wanted[joint][0].get<double>(), 1e-6);
        EXPECT_NEAR(rows[i][3 * joint + 1], 0, 1e-12);
        EXPECT_NEAR(rows[i][3 * joint + 2], wanted[joint][1].get<double>(), 1e-6);
      }
    }
  }
}

TEST_F(Kin, ReadsNumbersAndWordsAlike) {
  const std::string wanted = "395.319744409 98.787141918 0\n";
  for (const char* row : {"250 0 -300", "250,0,-300", " 250.0 ,\t0, -3e2 \r", "X250 Y0 Z-300",
                          "z-300 x+250 y0", "X=250 Y=0 Z=-300"}) {
    const Outcome r = kin("ik -m ox-glide-crossed", row);
    EXPECT_EQ(r.out, wanted) << row;
    EXPECT_EQ(r.code, 0) << row;
  }
  const Outcome r = kin("fk -m ox-glide-crossed", "s3=0 S1=395.319744409 S2=98.787141918\n");
  EXPECT_EQ(r.out, "250 0 -300\n");
}

TEST_F(Kin, SaysPerRowWhatIsWrong) {
  const Outcome r = kin("ik -m ox-glide-crossed",
                        "450 0 -300\n250 0 -300\n250 0 -361.2\n1 2\n\nX1 Y2\nX1 2 3\n"
                        "X1 Y2 Q3\nX1 X2 Z3\nnan 0 0\n1e999 0 0\n");
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.out,
            "error: joint S1 would be at 595.319744, its limit is 500\n"
            "395.319744409 98.787141918 0\n"
            "error: rod 2 is 3.200 mm too short for Z -361.200; it reaches down to Z -358.000\n"
            "error: a row needs 3 numbers (X Y Z), this one has 2\n"
            "error: a row needs 3 numbers (X Y Z), this one has 0\n"
            "error: 'Z' is missing\n"
            "error: a row has either plain numbers or words with names, this one has both\n"
            "error: 'Q3' is neither a number nor one of the words X Y Z with a number, like X12.5\n"
            "error: 'X' is given twice\n"
            "error: 'nan' is neither a number nor one of the words X Y Z with a number, like "
            "X12.5\n"
            "error: '1e999' is neither a number nor one of the words X Y Z with a number, like "
            "X12.5\n");
}

TEST_F(Kin, SaysWhereTheJacobianIsNotFinite) {
  const Outcome r = kin("jac -m ox-glide-crossed", "250 0 -358\n");
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.out, "error: the joints would need an infinite speed there (a singular pose)\n");
}

// The tip moves along the tool then, which the interpreter does not know: never a pass.
TEST_F(Kin, ALengthOffsetThatChangesWhileTheToolIsTiltedIsNoPass) {
  std::ofstream(folder_ / "tilted.ngc")
      << "T1 M6\nG0 X0 Y0 Z100 A20 B0\nG43 H1\nG1 X1 F1000\nM30\n";
  const std::string command = "cd " AIRCUT_SOURCE_DIR " && timeout 60 " AIRCUT_BINARY_DIR
                              "/bin/aircut run -m lola50-vertical " +
                              (folder_ / "tilted.ngc").string() + " >" +
                              (folder_ / "out").string() + " 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2) << text_of("out");
  EXPECT_NE(text_of("out").find("tool length offset while the tool is tilted"), std::string::npos)
      << text_of("out");
}

// k = Rz(C)·Rx(A)·z of a trunnion A-C (kinematics.md e.2) gives A and C by hand; the tip comes back
// through fk.
TEST_F(Kin, FindsTheJointsForAToolVector) {
  const Outcome r = kin("ik --tool-vector -m mill5-ac", "10 20 200 0 -0.5 1\n10 0 150 1 0 1\n");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  const std::size_t split = r.out.find(" ; "), line = r.out.find('\n');
  ASSERT_LT(split, line) << r.out;
  const double a = std::atan2(0.5, 1) * 180 / std::numbers::pi;
  const auto first = rows_of(r.out.substr(0, split)).at(0);
  const auto second = rows_of(r.out.substr(split + 3, line - split - 3)).at(0);
  EXPECT_NEAR(first.at(3), a, 1e-9);
  EXPECT_NEAR(first.at(4), 0, 1e-9);
  EXPECT_NEAR(second.at(3), -a, 1e-9);
  EXPECT_NEAR(std::abs(second.at(4)), 180, 1e-9);
  // A may not be +45: of the second row one solution is left.
  const std::string last = r.out.substr(line + 1);
  EXPECT_EQ(last.find(';'), std::string::npos) << last;
  EXPECT_NEAR(rows_of(last).at(0).at(3), -45, 1e-9);
  EXPECT_NEAR(rows_of(last).at(0).at(4), -90, 1e-9);
  for (const auto& joints : {r.out.substr(0, split), r.out.substr(split + 3, line - split - 3)}) {
    const auto tip = rows_of(kin("fk -m mill5-ac", joints + "\n").out).at(0);
    EXPECT_NEAR(tip.at(0), 10, 1e-8);
    EXPECT_NEAR(tip.at(1), 20, 1e-8);
    EXPECT_NEAR(tip.at(2), 200, 1e-8);
  }
  const Outcome bad = kin("ik --tool-vector -m mill5-ac", "1 2 3 0 0 0\n1 2 100 0 0 -1\n");
  EXPECT_EQ(bad.code, 1);
  EXPECT_NE(bad.out.find("I J K has no length"), std::string::npos) << bad.out;
  EXPECT_NE(bad.out.find("its limit is"), std::string::npos) << bad.out;
  EXPECT_EQ(kin("ik --tool-vector -m mill3", "1 2 3 0 0 1\n").code, 2);
}

TEST_F(Kin, EndsWith2WhenThereIsNothingToAnswer) {
  EXPECT_EQ(kin("ik -m ox-glide-crossed", "").code, 2);
  EXPECT_EQ(kin("ik -m no-such-machine", "1 2 3\n").code, 2);
  EXPECT_EQ(kin("ik", "1 2 3\n").code, 2);
  EXPECT_EQ(kin("", "1 2 3\n").code, 2);
  const Outcome r = kin("kj -m mill3", "1 2 3\n");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("there is no command 'kj'"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace aircut
