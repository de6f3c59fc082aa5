// The machine packages as models: meshes that close, bodies that keep clear of each other over the
// whole travel, tools whose lengths fit the machine. What machines/README.md promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "base/random.h"
#include "collide/collide.h"
#include "machine/machine.h"
#include "tool/tool.h"

namespace aircut {
namespace {

using machine::Body;
using machine::JointId;
using machine::JointVector;
using machine::LinkId;
using machine::LinkPoses;
using machine::Machine;

constexpr double promised_gap = 8;  // mm, machines/README.md
constexpr std::size_t most_triangles = 20000;

std::vector<std::string> packages() {
  std::vector<std::string> folders;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(AIRCUT_SOURCE_DIR) + "/machines"))
    if (std::filesystem::exists(entry.path() / "machine.toml"))
      folders.push_back(entry.path().string());
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::shared_ptr<const Machine> read(const std::string& path, SourceMap& sources,
                                    const std::string& channel = {}) {
  Diagnostics out;
  auto result = machine::read_machine(path, sources, out, channel);
  for (const Diagnostic& d : out.list()) ADD_FAILURE() << format_gcc(d);
  return result ? *result : nullptr;
}

bool excluded(const Machine& machine, const Body& a, const Body& b) {
  const auto link_of = [&](LinkId id) -> const machine::Link& {
    return machine.links()[static_cast<std::size_t>(index(id))];
  };
  if (a.link == b.link) return true;
  if (a.role != machine::Role::fixture && b.role != machine::Role::fixture &&
      (link_of(a.link).parent == b.link || link_of(b.link).parent == a.link))
    return true;
  const auto is = [&](const std::string& name, const Body& body) {
    return name == body.name || name == link_of(body.link).name;
  };
  for (const machine::Exclusion& e : machine.exclusions())
    if ((is(e.a, a) && is(e.b, b)) || (is(e.a, b) && is(e.b, a))) return true;
  return false;
}

// Joints anywhere in the travel, every third time at an end of it, that the kinematics can
// assemble.
JointVector somewhere(const Machine& machine, Random& random) {
  for (int tries = 0; tries < 10000; ++tries) {
    JointVector joints(machine.joint_count());
    for (int i = 0; i < machine.joint_count(); ++i) {
      const machine::Joint& joint = machine.joint(JointId{i});
      const double where = std::clamp(random.between(-0.25, 1.25), 0.0, 1.0);
      const double low = std::isfinite(joint.min) ? joint.min : -std::numbers::pi;
      const double high = std::isfinite(joint.max) ? joint.max : std::numbers::pi;
      joints[i] = low + where * (high - low);
    }
    if (machine.kinematics().forward(joints, {})) return joints;
  }
  ADD_FAILURE() << "no joints of the travel can be assembled";
  return machine.home();
}

TEST(PackageModels, HaveClosedMeshesOfModestSize) {
  for (const std::string& folder : packages()) {
    SCOPED_TRACE(folder);
    SourceMap sources;
    const auto machine = read(folder, sources);
    ASSERT_TRUE(machine);
    for (const Body& body : machine->bodies()) {
      SCOPED_TRACE(body.name);
      EXPECT_LE(body.mesh->triangles.size(), most_triangles);
      for (const Shell& shell : shells(*body.mesh)) EXPECT_TRUE(shell.closed);
      double volume = 0;  // by the divergence theorem: positive when the faces look outwards
      for (const auto& t : body.mesh->triangles)
        volume += body.mesh->vertices[t[0]].dot(
                      body.mesh->vertices[t[1]].cross(body.mesh->vertices[t[2]])) /
                  6;
      EXPECT_GT(volume, 0);
    }
  }
}

bool carries(const Machine& machine, machine::LinkId link, machine::LinkId end) {
  while (end != machine::bed_link && end != link)
    end = machine.links()[static_cast<std::size_t>(index(end))].parent;
  return end == link && link != machine::bed_link;
}

// A head reaches a tilting table at the ends of its travel, a ram a turning one, a turret a spindle
// that comes to meet it or that it swivels to: of such a pair nothing is promised but at home. (The
// program decides; that is what runs are checked for.)
bool work_against_tool(const Machine& machine, const Body& a, const Body& b) {
  // A link on the way to the end or behind it, or one that turns on it: a spindle of the work.
  const auto side_of = [&](LinkId end, const Body& body) {
    const machine::Link& link = machine.links()[static_cast<std::size_t>(index(body.link))];
    const bool turns =
        link.joint >= 0 && link.parent == end &&
        machine.tree()[static_cast<std::size_t>(link.joint)].kind == machine::JointKind::rotary;
    return turns || carries(machine, body.link, end) || carries(machine, end, body.link);
  };
  const auto spindle = machine.spindle().link, work = machine.work_link();
  return (side_of(spindle, a) && side_of(work, b)) || (side_of(spindle, b) && side_of(work, a));
}

bool may_meet(const Machine& machine) {
  const std::string_view type = machine.kinematics().type();
  return type == "chain" || type == "lathe-vertical" || machine.channels().size() > 1;
}

void expect_bodies_apart(const Machine& machine) {
  std::vector<const Body*> bodies;
  std::vector<collide::CollisionMesh> meshes;
  for (const Body& body : machine.bodies())
    if (body.collide) {
      bodies.push_back(&body);
      meshes.emplace_back(*body.mesh);
    }
  Random random(7);
  LinkPoses poses;
  std::set<std::string> told;
  // An arm reaches its own pedestal and the table; apart at home is all that can be promised.
  const int positions = machine.kinematics().type().starts_with("robot") ? 1
                        : machine.channels().empty()                     ? 2000
                                                                         : 500;
  for (int k = 0; k < positions; ++k) {
    const JointVector joints = k == 0 ? machine.home() : somewhere(machine, random);
    machine::forward(machine, joints, poses);
    const auto pose = [&](std::size_t i) {
      return poses.X_WL[static_cast<std::size_t>(index(bodies[i]->link))] * bodies[i]->X_LB;
    };
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        if (excluded(machine, *bodies[i], *bodies[j])) continue;
        if (k > 0 && may_meet(machine) && work_against_tool(machine, *bodies[i], *bodies[j]))
          continue;
        const auto gap = collide::distance(meshes[i], pose(i), meshes[j], pose(j), promised_gap);
        const std::string pair = bodies[i]->name + " – " + bodies[j]->name;
        if (!gap.capped && told.insert(pair).second)
          ADD_FAILURE() << pair << ": " << gap.value << " mm at joints " << joints.transpose();
      }
  }
}

TEST(PackageModels, KeepTheirBodiesApartOverTheWholeTravel) {
  for (const std::string& folder : packages()) {
    SourceMap sources;
    const auto machine = read(folder, sources);
    ASSERT_TRUE(machine);
    std::vector<std::string> channels = machine->channels();
    if (channels.empty()) channels = {""};
    for (const std::string& channel : channels) {
      SCOPED_TRACE(folder + ":" + channel);
      const auto driven = channel == machine->channel() ? machine : read(folder, sources, channel);
      ASSERT_TRUE(driven);
      expect_bodies_apart(*driven);
    }
  }
}

TEST(PackageModels, HaveToolsWithHoldersThatFitTheSpindle) {
  for (const std::string& folder : packages()) {
    SCOPED_TRACE(folder);
    SourceMap sources;
    const auto machine = read(folder, sources);
    ASSERT_TRUE(machine);
    Diagnostics out;
    const auto tools = tool::read_tools(machine->default_tools_, 1.0, sources, out);
    for (const Diagnostic& d : out.list()) ADD_FAILURE() << format_gcc(d);
    ASSERT_TRUE(tools);
    EXPECT_GE(tools->tools.size(), 6u);
    for (const tool::Tool& tool : tools->tools) {
      SCOPED_TRACE(tool.name);
      if (!tool.blocks.empty()) {  // a lathe tool, held by blocks beside it
        EXPECT_GE(tool.blocks.size(), 2u) << "shank, holder";
        EXPECT_GT(tool.offset[Axis::z], 30);
        EXPECT_LE(tool.max_rpm, machine->spindle().max_rpm);
        continue;
      }
      EXPECT_GE(tool.pieces.size(), 3u) << "cutter, shank or neck, holder";
      EXPECT_NEAR(tool.offset[Axis::z], tool.gauge_length, 1e-9);
      EXPECT_LE(tool.max_rpm, machine->spindle().max_rpm);
      EXPECT_GT(tool.gauge_length, 60);
      EXPECT_LT(tool.gauge_length, 140);
    }
  }
}

}  // namespace
}  // namespace aircut
