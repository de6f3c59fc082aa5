// Programs that switch the kinematics of a LinuxCNC machine, through the command line.
#include <algorithm>
#include <cmath>
#include <vector>

#include "program.h"

namespace aircut {
namespace {

class SwitchedSetup : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    put("m428.ngc", sub("m428", 1));
    put("m429.ngc", sub("m429", 0));
    put("m430.ngc", sub("m430", 2));
    put("m.ini",
        "[TRAJ]\nLINEAR_UNITS=mm\nCOORDINATES=XYZAC\n[RS274NGC]\nHAL_PIN_VARS=1\n"
        "REMAP=M428 modalgroup=10 ngc=m428\nREMAP=M429 modalgroup=10 ngc=m429\n"
        "REMAP=M430 modalgroup=10 ngc=m430\n"
        "[KINS]\nKINEMATICS=xyzac-trt-kins sparm=identityfirst\nJOINTS=5\n"
        "[HAL]\nHALCMD=net k <= motion.analog-out-03 => motion.switchkins-type\n"
        "HALCMD=net l motion.tooloffset.z => xyzac-trt-kins.tool-offset\n" +
            joints());
  }
  // As a user writes it: switch, wait for the motion, look whether it is so.
  static std::string sub(const std::string& name, int number) {
    const std::string n = std::to_string(number);
    return "o<" + name + "> sub\nM68 E3 Q" + n + "\nM66 E0 L0\n" +
           "o1 if [#<_hal[motion.switchkins-type]> NE " + n + "]\n(print,wrong)\nM2\no1 endif\n" +
           "o<" + name + "> endsub\nM2\n";
  }
  static std::string joints() {
    std::string text;
    for (int i = 0; i < 5; ++i)
      text += "[JOINT_" + std::to_string(i) +
              "]\nMIN_LIMIT=-400\nMAX_LIMIT=400\nMAX_VELOCITY=50\nMAX_ACCELERATION=500\n";
    return text;
  }
  Outcome run(const std::string& program, const std::string& more = "") {
    put("p.ngc", program);
    return aircut("run " + path("p.ngc") + " -m " + path("m.ini") + " --force --log " +
                  path("j.csv") + " --check limits " + more);
  }
  // Joints in the last row of the log.
  std::vector<double> last_joints() {
    std::istringstream lines(text_of(path("j.csv")));
    std::string last;
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) last = line;
    std::replace(last.begin(), last.end(), ',', ' ');
    std::istringstream words(last);
    std::vector<double> all, joints;
    for (double value = 0; words >> value;) all.push_back(value);
    for (std::size_t j = 0; j < 5 && 7 + j < all.size(); ++j) joints.push_back(all[7 + j]);
    return joints;
  }
};

TEST_F(SwitchedSetup, FollowsTheAnalogOutputThatItsHalNames) {
  // C a quarter: in tool centre point control a way along X is one of the slide Y.
  const Outcome r = run("G21 G90 G94 F1000\nG0 X30 C90\nM428\nG91 G1 X10\nG90\nM429\nG1 Z5\nM2\n");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  const auto q = last_joints();
  ASSERT_EQ(q.size(), 5u);
  EXPECT_NEAR(q[0], 30, 1e-9);
  EXPECT_NEAR(std::abs(q[1]), 10, 1e-9);
  EXPECT_NEAR(q[2], 5, 1e-9);
  EXPECT_NEAR(q[4], 90, 1e-9);
  EXPECT_EQ(aircut("log check " + path("j.csv")).code, 0) << "the tip's jump is no way";
  EXPECT_EQ(aircut("check " + path("p.ngc") + " -m " + path("m.ini")).code, 0);
}

TEST_F(SwitchedSetup, IsUnknownWhereASwitchCantBeFollowed) {
  const std::string head = "G21 G90 G94 F1000\nG0 X30 C90\n";
  const Outcome third = run(head + "M430\nG1 X0\nM2\n");
  EXPECT_EQ(third.code, 2);
  EXPECT_TRUE(third.says("which this machine has not")) << third.out << third.err;
  EXPECT_NEAR(last_joints().at(0), 30, 1e-9) << "nothing moves behind it";
  const Outcome in_motion = run(head + "M67 E3 Q1\nG1 X0\nM2\n");
  EXPECT_EQ(in_motion.code, 2);
  EXPECT_TRUE(in_motion.says("M67")) << in_motion.out << in_motion.err;
  const Outcome not_waited = run(head + "M68 E3 Q1\nG1 X0\nM2\n");
  EXPECT_EQ(not_waited.code, 2);
  EXPECT_TRUE(not_waited.says("no M66 waits for it")) << not_waited.out << not_waited.err;
}

TEST_F(SwitchedSetup, DrivesAPackageByTheNamesOfItsChannels) {
  put("p.ngc", "G21 G90 G94 F1000\nG0 Z160 A-20\nM428\nG1 Z150\nM2\n");
  const std::string rest = " --ini " + path("m.ini") + " --check limits";
  const Outcome good = aircut("run " + path("p.ngc") + " -m mill5-ac:joints" + rest);
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  const Outcome other = aircut("run " + path("p.ngc") + " -m mill5-ac" + rest);
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(other.says("-m PACKAGE:joints")) << other.out << other.err;
}

}  // namespace
}  // namespace aircut
