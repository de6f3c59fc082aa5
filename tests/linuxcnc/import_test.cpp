// Machines of set-ups: what the import moves is compared with the formulas of the modules, written
// out by hand here.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "linuxcnc/linuxcnc.h"
#include "machine/machine.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;

/// `count` joints with limits; those named in `angular` turn.
std::string joints(int count, const std::string& angular = "", double home = 0) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += "[JOINT_" + std::to_string(i) + "]\nTYPE=" +
            (angular.find(static_cast<char>('0' + i)) != angular.npos ? "ANGULAR" : "LINEAR") +
            "\nMIN_LIMIT=-400\nMAX_LIMIT=900\nMAX_VELOCITY=50\nMAX_ACCELERATION=500\nHOME=" +
            shortest(home) + "\n";
  return text;
}

class ImportedMachine : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("import_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Null when it is refused.
  std::shared_ptr<const machine::Machine> read_file(const std::string& path,
                                                    const std::string& channel = {}) {
    out_ = {};
    auto imported = linuxcnc::import_machine(path, sources_, out_);
    if (!imported || !*imported) return nullptr;
    import_ = **imported;
    const SourceText& text = sources_.add("machine", import_.toml);
    const auto machine = machine::read_machine(text, ".", sources_, out_, channel);
    return machine ? *machine : nullptr;
  }
  std::shared_ptr<const machine::Machine> read(const std::string& kins, const std::string& rest,
                                               const std::string& channel = {}) {
    write("m.ini", "[KINS]\nKINEMATICS=" + kins + "\n[TRAJ]\nLINEAR_UNITS=mm\n" + rest);
    const auto machine = read_file((folder_ / "m.ini").string(), channel);
    for (const Diagnostic& d : out_.list())
      if (d.severity == Severity::error) ADD_FAILURE() << format_gcc(d) << import_.toml;
    return machine;
  }
  /// Reads what must be refused: `kind:line` of the errors.
  std::string refused(const std::string& kins, const std::string& rest) {
    write("m.ini", "[KINS]\nKINEMATICS=" + kins + "\n[TRAJ]\nLINEAR_UNITS=mm\n" + rest);
    EXPECT_FALSE(read_file((folder_ / "m.ini").string()));
    std::string all;
    for (const Diagnostic& d : out_.list())
      if (d.severity == Severity::error)
        all += (all.empty() ? "" : " ") + d.kind + ":" + std::to_string(d.span.line);
    return all;
  }
  bool says(const std::string& text) const {
    for (const Diagnostic& d : out_.list())
      if (d.message.find(text) != d.message.npos) return true;
    return false;
  }

  fs::path folder_;
  SourceMap sources_;
  Diagnostics out_;
  linuxcnc::MachineImport import_;
};

machine::JointVector vector(std::initializer_list<double> values) {
  machine::JointVector q(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) q[i++] = value;
  return q;
}

Vec3 tip(const machine::Machine& machine, const machine::JointVector& q, double tool = 0) {
  AxisValues offset;
  offset[Axis::z] = tool;
  const auto p = machine.kinematics().forward(q, offset);
  if (!p) {
    ADD_FAILURE() << p.error().reason;
    return Vec3::Zero();
  }
  return {(*p)[Axis::x], (*p)[Axis::y], (*p)[Axis::z]};
}

TEST_F(ImportedMachine, OfTrivkinsHasTheTighterLimitsOfJointAndAxis) {
  const auto good =
      read("trivkins coordinates=xz\nJOINTS=2",
           "MAX_LINEAR_VELOCITY=40\n[AXIS_X]\nMIN_LIMIT=-1\nMAX_VELOCITY=70\n" + joints(2, "", 3));
  ASSERT_TRUE(good);
  EXPECT_TRUE(import_.axes_are_joints);
  EXPECT_TRUE(import_.unchecked.empty());
  const machine::Joint& x = good->joint(machine::JointId{0});
  EXPECT_EQ(x.name, "X");
  EXPECT_EQ(x.min, -1);
  EXPECT_EQ(x.max, 900);
  EXPECT_EQ(x.vmax, 40);
  EXPECT_EQ(x.amax, 500);
  EXPECT_EQ(x.home, 3);
  EXPECT_EQ(good->joint(machine::JointId{1}).name, "Z");
  EXPECT_TRUE(good->bodies().empty());
}

TEST_F(ImportedMachine, IsInTheUnitOfItsSetup) {
  write("m.ini",
        "[KINS]\nKINEMATICS=trivkins\nJOINTS=4\n[TRAJ]\nLINEAR_UNITS=inch\n" + joints(4, "3", 2));
  const auto m = read_file((folder_ / "m.ini").string());
  ASSERT_TRUE(m);
  EXPECT_NEAR(m->joint(machine::JointId{2}).max, 900 * 25.4, 1e-9);
  EXPECT_NEAR(m->joint(machine::JointId{2}).home, 2 * 25.4, 1e-9);
  EXPECT_NEAR(m->joint(machine::JointId{3}).home, 2 * degree, 1e-12) << "A turns";
  EXPECT_EQ(import_.undrawn.size(), 1u) << "where A turns is not said";
}

TEST_F(ImportedMachine, WithALetterTwiceMovesBothJoints) {
  const auto m = read("trivkins coordinates=XYZY kinstype=BOTH\nJOINTS=4", joints(4));
  ASSERT_TRUE(m);
  AxisValues at;
  at[Axis::x] = 1, at[Axis::y] = 2, at[Axis::z] = 3;
  const auto q = m->kinematics().inverse({at, {}}, m->home());
  ASSERT_TRUE(q);
  EXPECT_TRUE(q->isApprox(vector({1, 2, 3, 2})));
  EXPECT_FALSE(m->kinematics().forward(vector({1, 2, 3, 4}), {})) << "2 mm askew";
}

TEST_F(ImportedMachine, OfXyzacTrtFollowsTheModulesFormula) {
  const auto m =
      read("xyzac-trt-kins\nJOINTS=5",
           joints(5, "34") +
               "[HAL]\nHALFILE=table.hal\nHALCMD=net :kinstype <= motion.analog-out-03 => "
               "motion.switchkins-type\n",
           "0");
  EXPECT_TRUE(m) << "no HAL file: all points are 0, and the tool's length is not known there";
  write("table.hal",
        "# a table\nsetp xyzac-trt-kins.x-rot-point 3\nsetp xyzac-trt-kins.y-rot-point [ROT]Y\n"
        "setp xyzac-trt-kins.z-rot-point -5.0e0\nsets :dy 20\nnet :dy xyzac-trt-kins.y-offset "
        "gui.y\nnet :dz xyzac-trt-kins.z-offset\nsets :dz 10\nnet :tool motion.tooloffset.z => \\\n"
        "  xyzac-trt-kins.tool-offset\n");
  const auto at = read("xyzac-trt-kins\nJOINTS=5",
                       joints(5, "34") +
                           "[ROT]\nY=7\n[HAL]\nHALFILE=table.hal\nHALCMD=net :kinstype <= "
                           "motion.analog-out-03 => motion.switchkins-type\n");
  ASSERT_TRUE(at);
  EXPECT_TRUE(import_.unchecked.empty());
  EXPECT_EQ(import_.switch_output, 3);
  EXPECT_EQ(at->channels(), (std::vector<std::string>{"tcp", "joints"}));
  const double a = 25 * degree, c = -40 * degree, L = 33, xr = 3, yr = 7, zr = -5, dy = 20;
  const double dz = 10 + L, jx = 11, jy = 12, jz = 13;
  const Vec3 expected(std::cos(c) * (jx - xr) + std::sin(c) * std::cos(a) * (jy - dy - yr) +
                          std::sin(c) * std::sin(a) * (jz - dz - zr) + std::sin(c) * dy + xr,
                      -std::sin(c) * (jx - xr) + std::cos(c) * std::cos(a) * (jy - dy - yr) +
                          std::cos(c) * std::sin(a) * (jz - dz - zr) + std::cos(c) * dy + yr,
                      -std::sin(a) * (jy - dy - yr) + std::cos(a) * (jz - dz - zr) + dz + zr - L);
  EXPECT_TRUE(tip(*at, vector({jx, jy, jz, a, c}), L).isApprox(expected, 1e-12))
      << tip(*at, vector({jx, jy, jz, a, c}), L).transpose() << " not " << expected.transpose();
}

TEST_F(ImportedMachine, StartsInTheModelThatTheSetupPutsFirst) {
  const auto m = read("xyzbc-trt-kins sparm=identityfirst\nJOINTS=5", joints(5, "34"));
  ASSERT_TRUE(m);
  EXPECT_EQ(m->channels(), (std::vector<std::string>{"joints", "tcp"}));
  EXPECT_EQ(m->kinematics().type(), "identity");
  EXPECT_EQ(import_.unchecked.size(), 1u) << "the tool's length does not get to the module";
}

TEST_F(ImportedMachine, OfXyzabTdrFollowsTheModulesFormula) {
  const auto m = read("xyzab_tdr_kins\nJOINTS=5",
                      joints(5, "34") +
                          "[HAL]\nHALCMD=setp xyzab_tdr_kins.x-rot-point 3\n"
                          "HALCMD=setp xyzab_tdr_kins.y-rot-point 4\n"
                          "HALCMD=setp xyzab_tdr_kins.z-rot-point 5\n"
                          "HALCMD=setp xyzab_tdr_kins.z-offset -10\n"
                          "HALCMD=net t motion.tooloffset.z xyzab_tdr_kins.tool-offset-z\n",
                      "tcp");
  ASSERT_TRUE(m);
  const double a = 25 * degree, b = -40 * degree, L = 9, dz = -10;
  const double px = 11 - 3, py = 12 - 4, pz = 13 - 5 - L;
  const double sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
  const Vec3 expected(cb * px + sb * pz + 3, sa * sb * px + ca * py - cb * sa * pz + sa * dz + 4,
                      -ca * sb * px + sa * py + ca * cb * pz - ca * dz + 5 + dz);
  EXPECT_TRUE(tip(*m, vector({11, 12, 13, a, b}), L).isApprox(expected, 1e-12));
}

TEST_F(ImportedMachine, OfHeadsTiltsTheOtherWay) {
  const std::string sum =
      "[HAL]\nHALCMD=loadrt sum2 names=both\nHALCMD=net l motion.tooloffset.z => both.in0\n"
      "HALCMD=setp both.in1 150\nHALCMD=net p <= both.out => ";
  const double b = 30 * degree, c = 50 * degree, L = 20;
  const auto bridge = read("5axiskins coordinates=xyzbcwy\nJOINTS=7",
                           joints(7, "34") + sum + "5axiskins.pivot-length\n");
  ASSERT_TRUE(bridge);
  EXPECT_TRUE(import_.unchecked.empty());
  EXPECT_TRUE(says("joints 5, 6 of 5axiskins"));
  // p = q + P (sin b cos c, sin b sin c, 1 − cos b), where P holds the tool.
  const double P = 150 + L;
  Vec3 expected(1 + P * std::sin(b) * std::cos(c), 2 + P * std::sin(b) * std::sin(c),
                3 + P - P * std::cos(b) - L);
  EXPECT_TRUE(tip(*bridge, vector({1, 2, 3, b, c}), L).isApprox(expected, 1e-12));

  const auto max = read("maxkins\nJOINTS=6", joints(6, "345") + sum + "maxkins.pivot-length\n");
  ASSERT_TRUE(max);
  // The head first, then the table.
  const double x = 1 + P * std::sin(b), y = 2;
  expected = Vec3(x * std::cos(c) - y * std::sin(c), x * std::sin(c) + y * std::cos(c),
                  3 - P * std::cos(b) + P - L);
  EXPECT_TRUE(tip(*max, vector({1, 2, 3, b, c}), L).isApprox(expected, 1e-12));
}

TEST_F(ImportedMachine, OfMillturnTurnsWithTheOtherAxes) {
  const auto mill = read("millturn\nJOINTS=4", joints(4, "3"));
  ASSERT_TRUE(mill);
  EXPECT_TRUE(tip(*mill, vector({1, 2, 3, 0.5})).isApprox(Vec3(1, 2, 3)));
  const auto turn = read("millturn\nJOINTS=4", joints(4, "3"), "1");
  ASSERT_TRUE(turn);
  EXPECT_TRUE(tip(*turn, vector({1, 2, 3})).isApprox(Vec3(3, -2, 1)));
}

TEST_F(ImportedMachine, OfAnArmHasTheWordsOfItsFlange) {
  std::string rows = "[HAL]\n";
  const double A[] = {0, 85, 380, 100, 0, 0}, D[] = {350, 0, 0, 425, 0, 235};
  const double alpha[] = {0, -90, 0, -90, 90, -90};
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i) + " ";
    rows += "HALCMD=setp genserkins.A-" + n + shortest(A[i]) + "\nHALCMD=setp genserkins.D-" + n +
            shortest(D[i]) + "\nHALCMD=setp genserkins.ALPHA-" + n + shortest(alpha[i] * degree) +
            "\n";
  }
  const auto m = read("genserkins\nJOINTS=6", joints(6, "012345") + rows);
  ASSERT_TRUE(m);
  const auto q = vector({0.1, -1.2, 0.2, 0.3, 1.1, 0.4});
  Pose X = Pose::Identity();
  for (int i = 0; i < 6; ++i)
    X = X * Eigen::AngleAxisd(alpha[i] * degree, Vec3::UnitX()) * Eigen::Translation3d(A[i], 0, 0) *
        Eigen::AngleAxisd(q[i], Vec3::UnitZ()) * Eigen::Translation3d(0, 0, D[i]);
  const auto at = m->kinematics().forward(q, {});
  ASSERT_TRUE(at);
  const Mat3 R = (Eigen::AngleAxisd((*at)[Axis::c], Vec3::UnitZ()) *
                  Eigen::AngleAxisd((*at)[Axis::b], Vec3::UnitY()) *
                  Eigen::AngleAxisd((*at)[Axis::a], Vec3::UnitX()))
                     .toRotationMatrix();
  EXPECT_TRUE(R.isApprox(X.linear(), 1e-9)) << R << "\n\n" << X.linear();
  EXPECT_TRUE(tip(*m, q).isApprox(X.translation(), 1e-9));
  const auto back = m->kinematics().inverse({*at, {}}, q * 1.05);
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->isApprox(q, 1e-7));
}

TEST_F(ImportedMachine, TellsWhatItDoesNotUnderstand) {
  write("kins.hal",
        "setp pumakins.A2 400\nsetp pumakins.colour 3\nfrobnicate pumakins\nsource more.hal\n"
        "setp pumakins.A3 [NONE]KEY\nnet p gui.d3 => pumakins.D3\n");
  const auto m =
      read("pumakins\nJOINTS=6", joints(6, "012345") +
                                     "[HAL]\nHALFILE=LIB:basic_sim.tcl\nHALFILE=kins.hal\n"
                                     "HALFILE=gone.hal\nHALFILE=x.tcl\n");
  ASSERT_TRUE(m);
  for (const char* text :
       {"pumakins.colour", "'frobnicate' is no command", "not read; name them with HALFILE",
        "no [NONE]KEY", "D3 comes from gui.d3", "there is no 'gone.hal'", "never run here"})
    EXPECT_TRUE(says(text)) << text;
  EXPECT_FALSE(says("basic_sim"));
  const auto has = [&](const char* text) {
    return std::any_of(import_.unchecked.begin(), import_.unchecked.end(),
                       [&](const std::string& s) { return s.find(text) != s.npos; });
  };
  for (const char* text : {"pumakins.colour", "gone.hal", "x.tcl", "D3 comes from"})
    EXPECT_TRUE(has(text)) << text;
}

TEST_F(ImportedMachine, IsRefusedWithThePlaceOfTheMistake) {
  EXPECT_EQ(refused("trivkinz\nJOINTS=3", joints(3)), "ini_kinematics:2");
  EXPECT_TRUE(says("Did you mean 'trivkins'")) << out_.list().front().message;
  EXPECT_EQ(refused("trivkins", joints(3)), "ini_kinematics:2") << "JOINTS is missing";
  EXPECT_EQ(refused("trivkins\nJOINTS=three", joints(3)), "ini_value:3");
  EXPECT_EQ(refused("trivkins\nJOINTS=20", joints(3)), "ini_value:3");
  EXPECT_EQ(refused("trivkins coordinates=XYZQ\nJOINTS=4", joints(4)), "ini_kinematics:2");
  EXPECT_EQ(refused("trivkins coordinates=XYZA\nJOINTS=3", joints(3)), "ini_kinematics:2");
  EXPECT_EQ(refused("trivkins\nJOINTS=1", "[JOINT_0]\nMAX_LIMIT=1 # mm\n"), "ini_value:7");
  EXPECT_EQ(refused("trivkins\nJOINTS=1", "[JOINT_0]\nMAX_VELOCITY=0\n"), "ini_value:2");
  EXPECT_EQ(refused("trivkins\nJOINTS=1", "[JOINT_0]\nMIN_LIMIT=5\nMAX_LIMIT=4\n"), "ini_value:2");
  EXPECT_EQ(refused("pumakins\nJOINTS=6", "[HAL]\nHALCMD=setp pumakins.A2 4OO\n"), "hal_value:7");
  EXPECT_EQ(refused("genserkins\nJOINTS=5", ""), "ini_kinematics:2");
  EXPECT_NE(refused("genhexkins\nJOINTS=6", ""), "") << "no base and no platform";
  EXPECT_FALSE(linuxcnc::import_machine((folder_ / "none.ini").string(), sources_, out_));
  write("plain.ini", "[TRAJ]\nLINEAR_UNITS=mm\n");
  const auto plain =
      linuxcnc::import_machine((folder_ / "plain.ini").string(), sources_, out_ = {});
  ASSERT_TRUE(plain);
  EXPECT_FALSE(*plain) << "a set-up without kinematics has no machine";
}

// What Debian's package brings. Left out is what the control would not start with either.
TEST_F(ImportedMachine, OfEverySampleOfLinuxcncIsRead) {
  const fs::path samples = "/usr/share/doc/linuxcnc/examples/sample-configs";
  std::error_code error;
  const char* skip = std::getenv("AIRCUT_NO_PEER");
  if (skip && std::string(skip) == "1") GTEST_SKIP() << "AIRCUT_NO_PEER=1";
  ASSERT_TRUE(fs::is_directory(samples, error)) << "linuxcnc's samples are not installed (Debian: "
                                                   "linuxcnc-uspace); AIRCUT_NO_PEER=1 skips this";
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(samples)) {
    if (entry.path().extension() != ".ini" || !entry.is_regular_file()) continue;
    const auto machine = read_file(entry.path().string());
    const std::string name = fs::relative(entry.path(), samples).string();
    if (out_.list().empty() && !machine) continue;  // no [KINS]
    read += machine != nullptr;
    EXPECT_TRUE(machine) << name;
    for (const Diagnostic& d : out_.list())
      if (d.severity == Severity::error) ADD_FAILURE() << format_gcc(d);
  }
  EXPECT_GT(read, 200);
}

}  // namespace
}  // namespace aircut::test
