// Robots' descriptions: what the machine moves is compared with the product of the description's
// own frames, joint by joint.
#include "urdf/urdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "machine/reading.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

struct J {
  const char *type, *xyz, *rpy, *axis;
};

// Links l0, l1, …, joined by j1, j2, …; the last one ends at a fixed link `tool0`.
std::string robot_of(const std::vector<J>& joints, const std::string& more = "") {
  std::string text = "<robot name=\"r\">\n<link name=\"l0\"/>\n";
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string n = std::to_string(i + 1), before = std::to_string(i);
    text += "<link name=\"l" + n + "\"/>\n<joint name=\"j" + n + "\" type=\"" + joints[i].type +
            "\"><parent link=\"l" + before + "\"/><child link=\"l" + n + "\"/><origin xyz=\"" +
            joints[i].xyz + "\" rpy=\"" + joints[i].rpy + "\"/><axis xyz=\"" + joints[i].axis +
            "\"/><limit lower=\"-2\" upper=\"2\" velocity=\"1.5\" effort=\"1\"/></joint>\n";
  }
  const std::string last = std::to_string(joints.size());
  return text + "<link name=\"tool0\"/>\n<joint name=\"flange\" type=\"fixed\"><parent link=\"l" +
         last +
         "\"/><child link=\"tool0\"/><origin xyz=\"0 0.02 0.1\" rpy=\"0 0.3 0\"/></joint>\n" +
         more + "</robot>\n";
}

Vec3 vector_of(const char* text) {
  Vec3 v;
  std::istringstream(text) >> v[0] >> v[1] >> v[2];
  return v;
}

Pose frame(const char* xyz, const char* rpy) {
  const Vec3 turns = vector_of(rpy);
  Pose X = translation(vector_of(xyz) * 1000);
  X.linear() =
      (Eigen::AngleAxisd(turns[2], Vec3::UnitZ()) * Eigen::AngleAxisd(turns[1], Vec3::UnitY()) *
       Eigen::AngleAxisd(turns[0], Vec3::UnitX()))
          .toRotationMatrix();
  return X;
}

Pose tool_of(const std::vector<J>& joints, const machine::JointVector& q) {
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    X = X * frame(joints[i].xyz, joints[i].rpy);
    const Vec3 axis = vector_of(joints[i].axis).normalized();
    if (std::string(joints[i].type) == "prismatic")
      X = X * translation(axis * value);
    else
      X = X * Eigen::AngleAxisd(value, axis);
  }
  return X * frame("0 0.02 0.1", "0 0.3 0");
}

class Urdf : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("urdf_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "arm_description/urdf");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file() const { return (folder_ / "arm_description/urdf/arm.urdf").string(); }
  Expected<urdf::Machine> make(const std::string& text, urdf::Options options = {}) {
    out_ = {};
    const auto robot = urdf::read_robot(sources_.add("arm.urdf", text), out_);
    if (!robot) return unexpected(robot.error());
    return urdf::machine_of(*robot, file(), options, out_);
  }
  std::shared_ptr<const machine::Machine> read(const std::string& text,
                                               urdf::Options options = {}) {
    const auto made = make(text, options);
    if (made) {
      made_ = *made;
      machine::PackageFiles files;
      files.mesh = [this](const std::string& path,
                          const MeshFileOptions&) -> Expected<std::shared_ptr<const TriangleMesh>> {
        return made_.meshes.at(path);
      };
      const auto machine =
          machine::read_machine_text(sources_.add("machine", made_.toml), ".", files, out_);
      if (machine) return *machine;
    }
    for (const Diagnostic& d : out_.list())
      if (d.severity == Severity::error) ADD_FAILURE() << format_gcc(d) << made_.toml;
    return nullptr;
  }
  /// What is wrong, with its place; the file must be refused.
  std::string refused(const std::string& text, urdf::Options options = {}) {
    EXPECT_FALSE(make(text, options));
    for (const Diagnostic& d : out_.list())
      if (d.severity == Severity::error) return std::to_string(d.span.line) + ": " + d.message;
    return "nothing is said";
  }

  fs::path folder_;
  SourceMap sources_;
  Diagnostics out_;
  urdf::Machine made_;
};

void expect_same_tool(const machine::Machine& machine, const std::vector<J>& joints) {
  for (int n = 1; n <= 20; ++n) {
    machine::JointVector q(machine.joint_count());
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = std::sin(7.3 * n + 2.1 * double(j));
    const Pose X = tool_of(joints, q);
    const auto tip = machine.kinematics().forward(q, {});
    ASSERT_TRUE(tip);
    const Vec3 p((*tip)[Axis::x], (*tip)[Axis::y], (*tip)[Axis::z]);
    EXPECT_LE((p - X.translation()).norm(), 1e-6);
    const auto axis = machine.kinematics().tool_axis(*tip);
    if (axis) {
      EXPECT_LE((*axis + X.linear().col(2)).norm(), 1e-9) << "the tool points out";
    }
    machine::LinkPoses poses;
    machine::forward(machine, q, poses);
    const Vec3 drawn = poses.X_WL[static_cast<std::size_t>(index(machine.spindle().link))] *
                       machine.spindle().gauge;
    EXPECT_LE((drawn - X.translation()).norm(), 1e-6);
  }
}

const std::vector<J> arm = {{"revolute", "0 0 0.3", "0 0 0", "0 0 1"},
                            {"revolute", "0.05 0.01 0.1", "-1.5708 0.1 0", "0 0 1"},
                            {"revolute", "0.4 0 0", "0 0 0.2", "0 0 1"},
                            {"revolute", "0.1 0.35 0", "1.5708 0 0", "0 0 -1"},
                            {"revolute", "0 0 0", "-1.5708 0 0.3", "0.2 0 0.9"},
                            {"continuous", "0 0.1 0", "1.5708 0 0", "0 0 1"}};

TEST_F(Urdf, ArmMovesAsItsFramesDo) {
  const auto m = read(robot_of(arm));
  ASSERT_TRUE(m);
  EXPECT_EQ(m->kinematics().type(), "serial");
  EXPECT_EQ(m->joint(machine::JointId{1}).name, "j2");
  EXPECT_EQ(m->joint(machine::JointId{1}).min, -2);
  EXPECT_EQ(m->joint(machine::JointId{1}).vmax, 1.5);
  EXPECT_TRUE(std::isinf(m->joint(machine::JointId{5}).max)) << "turns without end";
  expect_same_tool(*m, arm);
}

TEST_F(Urdf, SlidesAndTurnsMayBeMixedAndParallel) {
  const std::vector<J> mixed = {{"prismatic", "0 0 0", "0 0 0", "1 0 0"},
                                {"revolute", "0 0 0.2", "0 0 0", "0 0 1"},
                                {"revolute", "0.3 0 0", "0 0 0", "0 0 1"},
                                {"prismatic", "0.2 0 0", "3.14159265358979 0 0", "0 0 1"},
                                {"revolute", "0 0 0", "0 0 0", "0 0 1"},
                                {"revolute", "0 0 0", "0 0 0", "0 1 0"}};
  const auto m = read(robot_of(mixed));
  ASSERT_TRUE(m);
  expect_same_tool(*m, mixed);
}

TEST_F(Urdf, ThreeSlidesAreSolvedInClosedForm) {
  const std::vector<J> slides = {{"prismatic", "0 0 1", "0 0 0", "0 1 0"},
                                 {"prismatic", "0.1 0 0", "0 0 0.5", "-1 0 0"},
                                 {"prismatic", "0 0 0", "0 2.84159265358979 0", "0 0 1"}};
  const auto m = read(robot_of(slides));
  ASSERT_TRUE(m);
  EXPECT_EQ(m->kinematics().type(), "calibrated");
}

TEST_F(Urdf, HasTheBodiesOfItsLinksWhereTheyAre) {
  fs::create_directories(folder_ / "arm_description/meshes");
  std::ofstream(folder_ / "arm_description/meshes/base.stl", std::ios::binary)
      << stl_bytes(make_box(Vec3(0, 0, 0), Vec3(100, 200, 300)));
  std::string text = robot_of(arm);
  const std::string link = "<link name=\"l1\"/>";
  text.replace(text.find(link), link.size(),
               "<link name=\"l1\"><visual><geometry><sphere radius=\"9\"/></geometry></visual>"
               "<collision><origin xyz=\"0.01 0 0\"/><geometry><mesh "
               "filename=\"package://arm_description/meshes/base.stl\" scale=\"0.001 0.001 "
               "0.001\"/></geometry></collision><collision><geometry><cylinder radius=\"0.02\" "
               "length=\"0.5\"/></geometry></collision></link>");
  const auto m = read(text);
  ASSERT_TRUE(m);
  ASSERT_EQ(m->bodies().size(), 2u);
  const Box3 box = bounds(*m->bodies()[0].mesh);
  EXPECT_TRUE(box.min().isApprox(Vec3(10, 0, 300), 1e-5)) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(Vec3(110, 200, 600), 1e-5));
  EXPECT_NEAR(bounds(*m->bodies()[1].mesh).sizes().z(), 500, 1e-6);
  EXPECT_EQ(m->links()[static_cast<std::size_t>(index(m->bodies()[0].link))].name, "j1");
  text.replace(text.find("base.stl"), 8, "gone.stl");
  EXPECT_NE(refused(text).find("there is no such file"), std::string::npos);
  text.replace(text.find("package://arm_description/meshes/gone.stl"), 41, "package://other/x.stl");
  EXPECT_NE(refused(text).find("--package-root"), std::string::npos);
  text.replace(text.find("package://other/x.stl"), 21, "../../../x.stl");
  EXPECT_NE(refused(text).find("can't use"), std::string::npos);
}

TEST_F(Urdf, IsRefusedWithThePlaceOfTheMistake) {
  const auto expect = [&](const std::string& text, const std::string& said) {
    const std::string message = refused(text);
    EXPECT_NE(message.find(said), std::string::npos) << message;
  };
  const std::string good = robot_of(arm);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  expect("<robot", "1: this is no XML");
  expect("", "this is no XML");
  expect("<machine/>", "no <robot>");
  expect("<robot name=\"r\"/>", "no <link>");
  expect(with("type=\"revolute\"", "type=\"floating\""), "4: joint 'j1' is floating");
  expect(with("type=\"revolute\"", "type=\"ball\""), "4: joint 'j1' has the type 'ball'");
  expect(with("<parent link=\"l2\"/>", "<parent link=\"l22\"/>"), "8: there is no link 'l22'");
  expect(with("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>"), "has no direction");
  expect(with("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 l\"/>"), "must be 3 numbers");
  expect(with("velocity=\"1.5\"", "velocity=\"0\""), "velocity above 0");
  expect(with("lower=\"-2\"", "lower=\"3\""), "lower is above upper");
  expect(with("<link name=\"l3\"/>", "<link name=\"l3\"/><link name=\"l3\"/>"), "two links 'l3'");
  expect(robot_of(arm,
                  "<joint name=\"back\" type=\"fixed\"><parent link=\"l5\"/><child "
                  "link=\"l2\"/></joint>"),
         "close a loop");
  expect(robot_of(arm,
                  "<link name=\"a\"/><link name=\"b\"/><joint name=\"ab\" type=\"fixed\">"
                  "<parent link=\"a\"/><child link=\"b\"/></joint><joint name=\"ba\" "
                  "type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint>"),
         "in a loop of joints");
  expect(robot_of(arm, "<link name=\"alone\"/>"), "hangs on nothing");
  expect(robot_of({arm[0], arm[1]}), "2 joints that move");
  expect(robot_of({arm[0], arm[1], arm[2]}), "must point along -Z of the root");
  const std::string two = robot_of(arm,
                                   "<link name=\"eye\"/><joint name=\"e\" type=\"fixed\"><parent "
                                   "link=\"l5\"/><child link=\"eye\"/></joint>");
  expect(two, "several links end the robot (tool0, eye)");
  EXPECT_TRUE(read(two, {.tool_link = "tool0"}));
  EXPECT_NE(refused(two, {.tool_link = "tol0"}).find("Did you mean 'tool0'"), std::string::npos);
}

TEST_F(Urdf, TellsWhatItDoesNotLookAt) {
  const auto m = read(
      robot_of(arm,
               "<wings/><link name=\"finger\"/><joint name=\"grip\" type=\"prismatic\"><parent "
               "link=\"l6\"/><child link=\"finger\"/><axis xyz=\"1 0 0\"/><limit lower=\"0\" "
               "upper=\"0.1\" velocity=\"1\"/><mimic joint=\"j1\"/></joint>"),
      {.tool_link = "tool0"});
  ASSERT_TRUE(m);
  std::string all;
  for (const std::string& what : made_.unchecked) all += what + "\n";
  EXPECT_NE(all.find("'grip' is not on the way"), std::string::npos) << all;
  EXPECT_NE(all.find("accelerations"), std::string::npos);
  std::string said;
  for (const Diagnostic& d : out_.list()) said += d.message + "\n";
  EXPECT_NE(said.find("<wings> is not understood"), std::string::npos) << said;
}

}  // namespace
}  // namespace aircut::test
