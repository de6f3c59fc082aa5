// Every package in machines/ can be read, draws the machine that it drives, and finds its poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/random.h"
#include "machine/machine.h"
#include "machine/rotation/head.h"
#include "samples.h"

namespace aircut::machine {
namespace {

std::vector<std::string> packages() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(AIRCUT_SOURCE_DIR) + "/machines"))
    if (std::filesystem::exists(entry.path() / "machine.toml"))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

std::shared_ptr<const Machine> read(const std::string& path, SourceMap& sources,
                                    const std::string& channel = {}) {
  Diagnostics out;
  auto machine = read_machine(path, sources, out, channel);
  std::string text;
  for (const Diagnostic& d : out.list()) text += format_gcc(d) + "\n";
  EXPECT_TRUE(machine) << text;
  return machine ? *machine : nullptr;
}

Vec3 gauge_in_M(const Machine& machine, const JointVector& joints) {
  LinkPoses poses;
  forward(machine, joints, poses);
  const auto pose = [&](LinkId link) { return poses.X_WL[static_cast<std::size_t>(index(link))]; };
  const Pose X_WM = pose(machine.work_link()) * machine.X_LM();
  return X_WM.inverse() * pose(machine.spindle().link) * machine.spindle().gauge;
}

void expect_tree_is_driven(const Machine& machine) {
  Random random(21);
  const int wanted = round_trips(1000);
  int compared = 0;
  for (int tries = 0; tries < 100 * wanted && compared < wanted; ++tries) {
    JointVector joints(machine.joint_count());
    for (int i = 0; i < machine.joint_count(); ++i) {
      const Joint& joint = machine.joint(JointId{i});
      const double low = std::isfinite(joint.min) ? joint.min : -std::numbers::pi;
      const double high = std::isfinite(joint.max) ? joint.max : std::numbers::pi;
      const bool still =
          joint.kind == JointKind::rotary && machine.kinematics().type() == "identity";
      joints[i] = still ? 0 : random.between(low, high);
    }
    const auto tip = machine.kinematics().forward(joints, {});
    if (!tip) continue;
    ++compared;
    const Vec3 by_kinematics((*tip)[Axis::x], (*tip)[Axis::y], (*tip)[Axis::z]);
    ASSERT_LE((gauge_in_M(machine, joints) - by_kinematics).norm(), 1e-6);
    const auto back = machine.kinematics().inverse({*tip, {}}, joints);
    ASSERT_TRUE(back);
    ASSERT_LE((*back - joints).cwiseAbs().maxCoeff(), 1e-6);
  }
  EXPECT_EQ(compared, wanted);
}

TEST(Packages, TheTreeDrawsWhatTheKinematicsDrives) {
  ASSERT_GE(packages().size(), 9u);
  for (const std::string& path : packages()) {
    SourceMap sources;
    const auto machine = read(path, sources);
    ASSERT_TRUE(machine);
    std::vector<std::string> channels = machine->channels();
    if (channels.empty()) channels = {""};
    for (const std::string& channel : channels) {
      SCOPED_TRACE(path + ":" + channel);
      const auto driven = read(path, sources, channel);
      ASSERT_TRUE(driven);
      EXPECT_EQ(driven->channel(), channel);
      expect_tree_is_driven(*driven);
    }
  }
}

TEST(Packages, TheHeadOfTheGantryMillIsThatOfItsHeadTable) {
  SourceMap sources;
  const auto machine = read(std::string(AIRCUT_SOURCE_DIR) + "/machines/mill6-head-table", sources);
  ASSERT_TRUE(machine);
  // Y X Z C A B. With the table at zero the mount's place in M is what it is at home, and X Y Z.
  const auto tip_at = [&](const JointVector& q) {
    const AxisValues tip = machine->kinematics().forward(q, {}).value();
    return Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]);
  };
  const TwoAxisHead head;  // the table's sample entry
  const Vec3 mount = tip_at(machine->home()) - tip_on_head(head, {}, 0).translation();
  EXPECT_NEAR(mount.z(), 2390.784 - 600, 2e-3);
  Random random(31);
  for (int i = 0; i < 1000; ++i) {
    JointVector q(6);
    for (int j = 0; j < 3; ++j) q[j] = random.between(-700, 0);
    q[3] = random.between(-4, 4);
    q[4] = random.between(-1.6, 1.9);
    q[5] = 0;
    const Vec3 by_table =
        mount + Vec3(q[1], q[0], q[2]) + tip_on_head(head, {q[3], q[4]}, 0).translation();
    ASSERT_LE((tip_at(q) - by_table).norm(), 1e-9);
  }
}

TEST(Packages, HaveASpindleBodyAndNoWarnings) {
  for (const std::string& path : packages()) {
    SCOPED_TRACE(path);
    SourceMap sources;
    const auto machine = read(path, sources);
    ASSERT_TRUE(machine);
    Diagnostics out;
    check_model(*machine, out);
    for (const Diagnostic& d : out.list()) EXPECT_EQ(d.severity, Severity::info) << format_gcc(d);
    EXPECT_TRUE(std::any_of(machine->bodies().begin(), machine->bodies().end(),
                            [](const Body& body) { return body.role == Role::spindle; }));
  }
}

TEST(Packages, MeshesOfEqualFilesAreShared) {
  SourceMap sources;
  const std::string path = std::string(AIRCUT_SOURCE_DIR) + "/tests/machine/good/shared";
  const auto machine = read(path, sources);
  ASSERT_TRUE(machine);
  ASSERT_EQ(machine->bodies().size(), 3u);
  EXPECT_EQ(machine->bodies()[0].mesh, machine->bodies()[1].mesh);
  EXPECT_NE(machine->bodies()[0].mesh, machine->bodies()[2].mesh);  // other unit
}

TEST(Packages, AreFoundByFolderByFileAndByName) {
  const std::string folder = std::string(AIRCUT_SOURCE_DIR) + "/machines";
  const std::string file = folder + "/mill3/machine.toml";
  EXPECT_EQ(find_package(folder + "/mill3", {}).value(), file);
  EXPECT_EQ(find_package(file, {}).value(), file);
  EXPECT_EQ(find_package("mill3", {"/nowhere", folder}).value(), file);
  const auto wrong = find_package("mil3", {folder});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, "input");
  EXPECT_TRUE(wrong.error().message.starts_with(
      "there is no machine 'mil3'. Did you mean 'mill3'? Known machines: "))
      << wrong.error().message;
  EXPECT_FALSE(find_package(folder, {}));
  EXPECT_FALSE(find_package("", {folder}));
  EXPECT_FALSE(find_package("../machines/mil", {folder}));
  EXPECT_FALSE(find_package(std::string(AIRCUT_SOURCE_DIR) + "/CMakeLists.txt", {}));
}

}  // namespace
}  // namespace aircut::machine
