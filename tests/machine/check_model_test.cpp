#include <gtest/gtest.h>

#include "machine/machine.h"
#include "machine/mesh_check.h"

namespace aircut::machine {
namespace {

TEST(MeshBorder, ABoxHasNoneAndABoxWithoutAFaceHasOne) {
  TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(3, 4, 5));
  EXPECT_TRUE(without_border(box));
  box.triangles.pop_back();
  EXPECT_FALSE(without_border(box));
}

TEST(MeshBorder, ATriangleThatFacesTheWrongWayIsABorder) {
  TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(3, 4, 5));
  std::swap(box.triangles[0][0], box.triangles[0][1]);
  EXPECT_FALSE(without_border(box));
}

TEST(MeshBorder, ATJunctionIsNone) {
  // One face's triangle is cut at the middle of an edge that the neighbour keeps whole.
  TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(3, 4, 5));
  const auto cut = box.triangles[0];
  const auto middle = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.push_back((box.vertices[cut[0]] + box.vertices[cut[1]]) / 2);
  box.triangles[0] = {cut[0], middle, cut[2]};
  box.triangles.push_back({middle, cut[1], cut[2]});
  EXPECT_TRUE(without_border(box));
  box.vertices[middle] += Vec3(0, 0, 0.01);
  EXPECT_FALSE(without_border(box));
}

Body body(const std::string& name, TriangleMesh mesh) {
  Body b;
  b.name = name;
  b.role = Role::spindle;
  b.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  return b;
}

std::vector<std::string> told(Machine machine) {
  machine.kinematics_ = make_identity({});
  machine.spindle_.max_rpm = 1;
  machine.tool_change_.seconds = 1;
  Diagnostics out;
  check_model(machine, out);
  std::vector<std::string> texts;
  for (const Diagnostic& d : out.list()) texts.push_back(d.message);
  return texts;
}

TEST(CheckModel, TellsOpenInvertedAndOddlySizedMeshes) {
  TriangleMesh open = make_box(Vec3(0, 0, 0), Vec3(30, 40, 50));
  TriangleMesh inverted = open;
  open.triangles.pop_back();
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  Machine machine;
  machine.bodies_ = {body("good", make_box(Vec3(0, 0, 0), Vec3(30, 40, 50))), body("open", open),
                     body("inverted", inverted),
                     body("metres", make_box(Vec3(0, 0, 0), Vec3(0.3, 0.4, 0.5))),
                     body("nothing", {})};
  const auto texts = told(machine);
  ASSERT_EQ(texts.size(), 4u);
  EXPECT_TRUE(texts[0].starts_with("the mesh of body 'open' is open")) << texts[0];
  EXPECT_TRUE(texts[1].starts_with("the mesh of body 'inverted' is inside out")) << texts[1];
  EXPECT_EQ(texts[2], "body 'metres' is 0.500 mm long; check the unit of its mesh");
  EXPECT_EQ(texts[3], "body 'nothing' has no triangles");
}

}  // namespace
}  // namespace aircut::machine
