// Which tool made which piece of a milled surface.
#include "sim/checks/cut_tape.h"

#include <gtest/gtest.h>

#include <map>

namespace aircut::sim {
namespace {

// A block of 60 x 40 x 20 on z = 0.
machine::RawStock block() {
  machine::RawStock raw;
  raw.size = Vec3(60, 40, 20);
  TriangleMesh mesh;
  for (const double z : {0., 20.})
    for (const double y : {-20., 20.})
      for (const double x : {-30., 30.}) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  raw.mesh = std::make_shared<TriangleMesh>(mesh);
  raw.pitch = 0.5;
  return raw;
}

class ByTool : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto flat = stock::CutterProfile::flat(10, 40);
    const auto *first = tape.keep(*flat, 3), *second = tape.keep(*flat, 7);
    // T3 a slot along X to z = 15; T7 one along Y to z = 10; T3 again over both, taking nothing.
    add(first, {-40, 0, 15}, {40, 0, 15}, 1);
    add(second, {0, -30, 10}, {0, 30, 10}, 2);
    add(first, {-40, 0, 15}, {40, 0, 15}, 3);
  }
  void add(const stock::CutterProfile* cutter, const Vec3& from, const Vec3& to, double t) {
    ASSERT_TRUE(tape.add({cutter, from, to, Vec3::UnitZ(), 0}, t - 1, t));
  }
  std::map<int, TriangleMesh> at(double t) {
    const auto history = tape.play(block(), 300);
    EXPECT_TRUE(history);
    const auto pieces = (*history)->by_tool(t);
    EXPECT_TRUE(pieces);
    std::map<int, TriangleMesh> out;
    for (const auto& piece : *pieces) out[piece.tool] = *piece.mesh;
    return out;
  }
  static double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
      sum += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                 .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                 .norm() /
             2;
    return sum;
  }
  CutTape tape = *CutTape::make();
};

TEST_F(ByTool, TheRawSurfaceBelongsToNone) {
  const auto pieces = at(0);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(area(pieces.at(0)), 2 * (60 * 40 + 60 * 20 + 40 * 20), 20);
}

TEST_F(ByTool, ASurfaceBelongsToTheToolThatMadeItLast) {
  const auto pieces = at(10);
  ASSERT_EQ(pieces.size(), 3u);
  // T3: floor and walls of the slot along X outside of the other one; T7 its own, ends included,
  // and where it crosses the slot. Along its edges a strip of a cell, 0.5 wide, is the older one.
  EXPECT_NEAR(area(pieces.at(3)), 50 * (10 + 2 * 5), 60);
  EXPECT_NEAR(area(pieces.at(7)), 10 * 40 + 2 * (40 * 10 - 10 * 5), 90);
  for (const Vec3& v : pieces.at(7).vertices) {
    EXPECT_LT(std::abs(v.x()), 5.6);
    EXPECT_GT(v.z(), 9.4);
  }
  for (const Vec3& v : pieces.at(3).vertices) EXPECT_LT(std::abs(v.y()), 5.6);
}

TEST_F(ByTool, OnlyWhatIsCutByThenIsTold) {
  EXPECT_EQ(at(1).count(7), 0u);
  EXPECT_EQ(at(2).count(7), 1u);
}

TEST_F(ByTool, ACutUnderWayIsDoneAsFarAsItIs) {
  // A quarter of the way from y = -30: the tool's end is at y = -15 and reaches to -10.
  double farthest = -20;
  const auto pieces = at(1.25);
  for (const Vec3& v : pieces.at(7).vertices) farthest = std::max(farthest, v.y());
  EXPECT_NEAR(farthest, -10, 0.6);
}

TEST_F(ByTool, ThePiecesAreTheWholeSurface) {
  const auto history = tape.play(block(), 300);
  const auto whole = (*history)->at(10);
  ASSERT_TRUE(whole);
  double sum = 0;
  for (const auto& [tool, mesh] : at(10)) sum += area(mesh);
  EXPECT_NEAR(sum, area(**whole), 1e-6 * sum);
}

}  // namespace
}  // namespace aircut::sim
