// Machines of other formats through the command line.
#include "program.h"

namespace aircut {
namespace {

class Import : public Program {};

const std::string gantry =
    "[KINS]\nKINEMATICS=trivkins coordinates=XYYZ\nJOINTS=4\n[TRAJ]\nLINEAR_UNITS=mm\n"
    "COORDINATES=XYYZ\n";

std::string joints() {
  std::string text;
  for (int i = 0; i < 4; ++i)
    text += "[JOINT_" + std::to_string(i) +
            "]\nMIN_LIMIT=-50\nMAX_LIMIT=50\nMAX_VELOCITY=20\nMAX_ACCELERATION=200\n";
  return text;
}

TEST_F(Import, RunsOnTheMachineOfASetup) {
  put("m.ini", gantry + joints());
  put("p.ngc", "G21 G90\nG1 X10 Y20 F600\nM2\n");
  const Outcome run = aircut("run " + path("p.ngc") + " -m " + path("m.ini") + " --log " +
                             path("j.csv") + " --check limits");
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_NE(text_of(path("j.csv")).find("Y2"), std::string::npos) << "both drives are in the log";
  const Outcome bodies = aircut("run " + path("p.ngc") + " -m " + path("m.ini"));
  EXPECT_EQ(bodies.code, 2);
  EXPECT_TRUE(bodies.says("a set-up has no bodies")) << bodies.out;
  put("far.ngc", "G21 G90\nG1 X60 F600\nM2\n");
  for (const char* command : {"run ", "check "})
    EXPECT_EQ(aircut(command + path("far.ngc") + " -m " + path("m.ini")).code, 1) << command;
  const Outcome fk = aircut("kin fk -m " + path("m.ini"), "1 2 2 3\n");
  EXPECT_EQ(fk.out, "1 2 3\n") << fk.err;
}

TEST_F(Import, SaysWhereASetupHasNoMachine) {
  put("m.ini", "[KINS]\nKINEMATICS=ballkins\nJOINTS=3\n");
  put("p.ngc", "M2\n");
  const Outcome run = aircut("run " + path("p.ngc") + " -m " + path("m.ini"));
  EXPECT_EQ(run.code, 2);
  EXPECT_TRUE(run.says("m.ini:2:12")) << run.err;
  EXPECT_EQ(aircut("kin fk -m " + path("none.ini"), "1\n").code, 2);
  put("m.ini", "[TRAJ]\nLINEAR_UNITS=mm\n");
  EXPECT_TRUE(aircut("kin fk -m " + path("m.ini"), "1\n").says("no [KINS]KINEMATICS"));
}

TEST_F(Import, WritesPackagesThatAreMachines) {
  put("m.ini", gantry + joints());
  EXPECT_EQ(aircut("machine import " + path("m.ini") + " " + path("one")).code, 0);
  EXPECT_EQ(aircut("machine import " + path("m.ini") + " " + path("one")).code, 2) << "it exists";
  EXPECT_EQ(aircut("machine check " + path("one")).code, 0);
  std::string robot = "<robot name=\"r\"><link name=\"l0\"/>";
  const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
  for (int i = 0; i < 3; ++i)
    robot += "<link name=\"l" + std::to_string(i + 1) +
             "\"><collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>"
             "<joint name=\"j" +
             std::to_string(i) + "\" type=\"prismatic\"><parent link=\"l" + std::to_string(i) +
             "\"/><child link=\"l" + std::to_string(i + 1) + "\"/><axis xyz=\"" + axes[i] +
             "\"/><limit lower=\"-1\" upper=\"1\" velocity=\"1\"/></joint>";
  put("r.urdf", robot + "</robot>");
  const Outcome fk = aircut("kin ik -m " + path("r.urdf"), "10 20 30\n");
  EXPECT_EQ(fk.code, 0) << fk.err;
  const Outcome made = aircut("machine import " + path("r.urdf") + " " + path("two"));
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(made.says("3 meshes")) << made.out;
  EXPECT_EQ(aircut("kin ik -m " + path("two"), "10 20 30\n").out, fk.out);
  put("bad.urdf", "<robot/>");
  EXPECT_EQ(aircut("machine import " + path("bad.urdf") + " " + path("three")).code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("three"))) << "nothing is written";
  EXPECT_EQ(aircut("machine import " + path("p.txt") + " " + path("three")).code, 2);
}

}  // namespace
}  // namespace aircut
