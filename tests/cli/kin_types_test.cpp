// Kinematics without a package, new packages and workspaces through the command line.
#include <gtest/gtest.h>

#include <cmath>

#include "kin_program.h"

namespace aircut {
namespace {

class KinTypes : public Kin {
 protected:
  Outcome run(const std::string& arguments) const {
    const std::string command = "cd " + folder_.string() + " && timeout 120 " +
                                std::filesystem::absolute(AIRCUT_BINARY_DIR).string() +
                                "/bin/aircut " + arguments + " >" + (folder_ / "out").string() +
                                " 2>" + (folder_ / "err").string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of("out"), text_of("err")};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
};

TEST_F(KinTypes, AnswerWithoutAPackage) {
  const Outcome ik = kin("ik --type delta-linear --param radius=120 --param rod=250", "0 0 -150\n");
  EXPECT_EQ(ik.code, 0) << ik.err;
  const double height = -150 + std::sqrt(250.0 * 250 - 120.0 * 120);
  const auto heights = rows_of(ik.out).at(0);
  for (const double q : heights) EXPECT_NEAR(q, height, 1e-8);
  const Outcome fk = kin("fk --type delta-linear --param radius=120 --param rod=250", ik.out);
  EXPECT_NEAR(rows_of(fk.out).at(0).at(2), -150, 1e-8) << fk.out;
  const Outcome jac = kin("jac --type corexy", "1 2 3\n");
  EXPECT_EQ(jac.out, "1 1 0 1 -1 0 0 0 1\n");
  EXPECT_EQ(kin("ik --type delta-linear", "900 0 0\n").code, 1);
}

TEST_F(KinTypes, SayWhatIsWrongWithThem) {
  const Outcome name = kin("ik --type hexpod", "1 2 3\n");
  EXPECT_EQ(name.code, 2);
  EXPECT_NE(name.err.find("Did you mean 'hexapod'?"), std::string::npos) << name.err;
  const Outcome key = kin("ik --type scara --param l3=5", "1 2 3 4\n");
  EXPECT_EQ(key.code, 2);
  EXPECT_NE(key.err.find("l3"), std::string::npos) << key.err;
  EXPECT_EQ(kin("ik --type scara -m mill3", "1 2 3\n").code, 2);
  EXPECT_EQ(kin("ik --param l1=5", "1 2 3\n").code, 2);
}

TEST_F(KinTypes, SweepGivesTheGridWithTheLastWordFastest) {
  const Outcome r = kin("sweep -m mill3 X=0:20:10 Y=5 Z=-600:-100:500", "");
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_EQ(r.out,
            "0 5 -600 ; error: joint Z would be at -600, its limit is -400\n"
            "0 5 -100 ; 0 5 -100\n"
            "10 5 -600 ; error: joint Z would be at -600, its limit is -400\n"
            "10 5 -100 ; 10 5 -100\n"
            "20 5 -600 ; error: joint Z would be at -600, its limit is -400\n"
            "20 5 -100 ; 20 5 -100\n");
  for (const char* bad : {"Q=1", "X=1:2", "X=2:1:1", "X=0:1:0", "X", "X=0:1e9:1e-9", "X=1:2:3:4"})
    EXPECT_EQ(kin(std::string("sweep -m mill3 ") + bad, "").code, 2) << bad;
}

TEST_F(KinTypes, WorkspaceTellsWhatAMachineReaches) {
  const std::string root = std::filesystem::absolute(AIRCUT_SOURCE_DIR "/machines/").string();
  const Outcome glide =
      run("workspace -m " + root + "ox-glide-crossed --x 0:600 --y 0 --z=-380:-74 --pitch 2");
  EXPECT_EQ(glide.code, 0) << glide.err;
  EXPECT_NE(glide.out.find("300 x 1 x 153 cells"), std::string::npos) << glide.out;
  EXPECT_NE(glide.out.find("joint S1 beyond its travel"), std::string::npos) << glide.out;
  EXPECT_EQ(run("workspace -m " + root + "ox-glide-crossed --x 5:1").code, 2);
  const std::string slice = "workspace -m " + root + "mill5-ac --x=-250:250 --y=-200:200 --z 20";
  const Outcome picture = run(slice + " --pitch 50 --collision-free --tool 1 -o w.png");
  EXPECT_EQ(picture.code, 0) << picture.out << picture.err;
  EXPECT_NE(picture.out.find("bodies touch"), std::string::npos) << picture.out;
  EXPECT_GT(fs::file_size(folder_ / "w.png"), 5000u);
  EXPECT_EQ(run("workspace -m " + root + "mill5-ac --x 0:100 --y 0 --z 100 -o line.png").code, 2)
      << "a line is no picture";
  EXPECT_EQ(run(slice + " --pitch 50 --tool 99").code, 2);
  EXPECT_EQ(run("workspace -m " + root + "mill3 --tilt-a 0:5").code, 2);
  EXPECT_EQ(run("workspace -m " + root + "mill3 --pitch 0.05").code, 2);
}

TEST_F(KinTypes, ANewPackageIsRunAtOnce) {
  write("part.ngc", "G21 G90\nG0 X100 Z-50\nG1 X40 F500\nZ-200\nG0 X100\nM30\n");
  const Outcome made = run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' lathe");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("R(MS:C)-O-T(LS:Z)-T(TS:X)"), std::string::npos);
  const Outcome check = run("machine check ./lathe");
  EXPECT_EQ(check.code, 0) << check.out;
  EXPECT_NE(check.out.find("lathe: 0 problems"), std::string::npos) << check.out;
  const Outcome part = run("run -m ./lathe part.ngc");
  EXPECT_EQ(part.code, 0) << part.out << part.err;
  EXPECT_EQ(run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' lathe").code, 2);
  const Outcome bad = run("machine new --formula 'R(MS)-O-T(QQ)' other");
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.err.find(":1:11"), std::string::npos) << bad.err;
  const Outcome two_beds = run("machine new --formula 'R(MS:C)-O-T(LS:Z)-O-T(TS:X)' other");
  EXPECT_EQ(two_beds.code, 2);
  EXPECT_NE(two_beds.err.find(":1:19"), std::string::npos) << two_beds.err;
  EXPECT_NE(two_beds.err.find("O stands twice"), std::string::npos) << two_beds.err;
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(KinTypes, AChannelIsTakenByNameOrByNumber) {
  // mill-turn: gauge point at Z870 with the joint Z at zero; joints Z X Y B C and Z X.
  const auto mill = rows_of(kin("ik -m mill-turn --kinstype 0", "100 0 200 0 0\n").out).at(0);
  ASSERT_EQ(mill.size(), 5u);
  EXPECT_NEAR(mill[0], -670, 1e-9);
  EXPECT_NEAR(mill[1], 100, 1e-9);
  EXPECT_EQ(kin("ik -m mill-turn --kinstype 1", "100 200\n").out, "-670 100\n");
  EXPECT_EQ(kin("ik -m mill-turn:turn", "X100 Z200\n").out, "-670 100\n");
  EXPECT_EQ(kin("ik -m mill3 --kinstype 0", "1 2 -3\n").out, "1 2 -3\n");
  const Outcome far = kin("ik -m mill-turn --kinstype 2", "1 2\n");
  EXPECT_EQ(far.code, 2);
  EXPECT_NE(far.err.find("there is no channel '2'"), std::string::npos) << far.err;
  const Outcome none = kin("ik -m mill3 --kinstype 1", "1 2 3\n");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("has no channels"), std::string::npos) << none.err;
  const Outcome wrong = kin("ik -m mill-turn:tunr", "1 2\n");
  EXPECT_NE(wrong.err.find("Did you mean 'turn'?"), std::string::npos) << wrong.err;
}

// With the tool centre point control off the tip leaves the place that it keeps with it on.
TEST_F(KinTypes, ToolCentrePointControlIsAChannelOfItsOwn) {
  const std::string joints = "5 6 -50 -20 90\n";
  const auto tcp = rows_of(kin("fk -m mill5-ac:tcp", joints).out).at(0);
  const auto off = rows_of(kin("fk -m mill5-ac:joints", joints).out).at(0);
  EXPECT_EQ(off, (std::vector<double>{5, 6, 350, -20, 90}));
  EXPECT_GT(std::hypot(tcp[0] - off[0], tcp[1] - off[1]), 100);
}

TEST_F(KinTypes, BodiesThatOverlapAtHomeAreFound) {
  ASSERT_EQ(run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' lathe").code, 0);
  const std::string toml = text_of("lathe/machine.toml");
  // The turret is at X 200 there.
  write("lathe/machine.toml", toml +
                                  "\n[[body]]\nname = \"block\"\nlink = \"bed\"\n"
                                  "mesh = \"meshes/turret.stl\"\npose = [190, 7, 9]\n");
  const Outcome r = run("machine check ./lathe");
  EXPECT_EQ(r.code, 1) << r.out;
  EXPECT_NE(r.out.find("`block`"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("`turret`"), std::string::npos) << r.out;
}

/// Packages written here take their meshes from a new one.
std::string axis_toml(const std::string& name, const std::string& parent, const std::string& rest) {
  return "[[axis]]\nname = \"" + name + "\"\nchild = \"" + name + "\"\nparent = \"" + parent +
         "\"\n" + rest + "\n";
}
const char* const two_bodies =
    "[[body]]\nlink = \"bed\"\nmesh = \"meshes/bed.stl\"\n"
    "[[body]]\nlink = \"tool\"\nrole = \"spindle\"\nmesh = \"meshes/turret.stl\"\n";
const std::string limits = "vmax = 200\namax = 2000\n";

// An arm that is solved numerically: its joints' ways are bounded from its Jacobian.
TEST_F(KinTypes, ARunOnANumericArmPasses) {
  ASSERT_EQ(run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' arm").code, 0);
  const std::string up = "direction = [0, 0, 1]\n" + limits;
  write("arm/machine.toml",
        "schema = 1\nname = \"arm\"\n[kinematics]\ntype = \"serial\"\nkinds = \"RRT\"\n"
        "convention = \"standard\"\ndh = [[0, 490, 340, 0], [0, 0, 250, 0], [0, 0, 0, 0]]\n"
        "tool = [0, 0, 0, 0, 0, 0]\n[spindle]\nlink = \"tool\"\ngauge = [590, 0, 490]\n" +
            axis_toml("a", "bed",
                      up + "kind = \"rotary\"\norigin = [0, 0, 0]\nmin = -170\nmax = 170") +
            axis_toml(
                "b", "a",
                up + "kind = \"rotary\"\norigin = [340, 0, 0]\nmin = 10\nmax = 150\nhome = 60") +
            axis_toml("tool", "b", up + "kind = \"linear\"\nmin = -400\nmax = 0") + two_bodies);
  write("part.ngc", "G21 G90\nG0 X350 Y300 Z400\nX300\nM30\n");
  const Outcome r = run("run -m ./arm part.ngc");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_NE(r.out.find("100 % proven clear"), std::string::npos) << r.out;
}

// The classical arm of six joints, in the middle of its travel.
TEST_F(KinTypes, ARunOnANumericArmOfSixJointsPasses) {
  ASSERT_EQ(run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' six").code, 0);
  const auto turn = [](const char* name, const char* parent, const char* origin,
                       const char* direction, const char* home) {
    return axis_toml(name, parent,
                     limits + "kind = \"rotary\"\nmin = -170\nmax = 170\norigin = " + origin +
                         "\ndirection = " + direction + "\nhome = " + home);
  };
  write("six/machine.toml",
        "schema = 1\nname = \"six\"\n[kinematics]\ntype = \"serial\"\n"
        "tool = [0, 0, 70, 180, 0, 0]\n[spindle]\nlink = \"tool\"\ngauge = [350, 70, -470]\n" +
            turn("J1", "bed", "[0, 0, 0]", "[0, 0, 1]", "20") +
            turn("J2", "J1", "[0, 0, 0]", "[0, 1, 0]", "-50") +
            turn("J3", "J2", "[300, 0, 0]", "[0, 1, 0]", "20") +
            turn("J4", "J3", "[350, 70, 0]", "[0, 0, -1]", "10") +
            turn("J5", "J4", "[350, 70, -400]", "[0, 1, 0]", "40") +
            turn("tool", "J5", "[350, 70, -400]", "[0, 0, -1]", "5") + two_bodies);
  write("part.ngc", "G21 G90\nG91\nG0 X20\nY20\nZ-20\nX-20 Y-20 Z20\nA3 B-2 C4\nM30\n");
  const Outcome r = run("run -m ./six part.ngc");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_NE(r.out.find("100 % proven clear"), std::string::npos) << r.out;
}

// A delta by its type: proven clear over the whole program.
TEST_F(KinTypes, ARunOnADeltaPasses) {
  ASSERT_EQ(run("machine new --formula 'R(MS:C)-O-T(LS:Z)-T(TS:X)' delta").code, 0);
  std::string toml =
      "schema = 1\nname = \"delta\"\n[kinematics]\ntype = \"delta-linear\"\n[spindle]\n"
      "link = \"tool\"\ngauge = [0, 0, 0]\n";
  for (const char* name : {"S1", "S2", "S3"})
    toml += axis_toml(name, "bed",
                      limits +
                          "kind = \"linear\"\ndirection = [0, 0, 1]\nmin = 80\n"
                          "max = 400\nhome = 235.367");
  toml +=
      axis_toml("px", "bed", "kind = \"linear\"\ndirection = [1, 0, 0]\npassive = \"platform_x\"");
  toml +=
      axis_toml("py", "px", "kind = \"linear\"\ndirection = [0, 1, 0]\npassive = \"platform_y\"");
  toml +=
      axis_toml("tool", "py", "kind = \"linear\"\ndirection = [0, 0, 1]\npassive = \"platform_z\"");
  write("delta/machine.toml", toml + two_bodies);
  write("part.ngc",
        "G21 G90\nG1 X30 Y20 Z-40 F3000\nG2 X-30 Y20 I-30 J-20\nG1 Z20\nX0 Y0 Z0\nM30\n");
  const Outcome r = run("run -m ./delta part.ngc");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_NE(r.out.find("100 % proven clear"), std::string::npos) << r.out;
}

}  // namespace
}  // namespace aircut
