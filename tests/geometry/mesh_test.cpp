#include <gtest/gtest.h>

#include "geometry/geometry.h"

namespace aircut {
namespace {

TriangleMesh triangle_soup(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const auto& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    for (const auto v : t) out.vertices.push_back(mesh.vertices[v]);
    out.triangles.push_back({n, n + 1, n + 2});
  }
  return out;
}

TriangleMesh unit_cube() { return make_box(Vec3::Zero(), Vec3::Ones()); }

TEST(Welding, GivesACubeEightVertices) {
  const TriangleMesh mesh = welded(triangle_soup(unit_cube()));
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(volume(mesh), 1.0);
}

TEST(Welding, KeepsPositionsApartThatDifferInTheLastBit) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {std::nextafter(1.0, 2.0), 0, 0},
                   {2, 2, 0}, {3, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  EXPECT_EQ(welded(mesh).vertices.size(), 6u);
}

TEST(Welding, TakesMinusZeroForZero) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {1, 0, -0.0}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {4, 3, 5}};
  EXPECT_EQ(welded(mesh).vertices.size(), 4u);
}

TEST(Welding, DropsTrianglesWithoutAreaAndTheirVertices) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7}};
  mesh.triangles = {{3, 4, 5}, {0, 1, 2}, {0, 0, 1}};
  const TriangleMesh out = welded(mesh);
  EXPECT_EQ(out.triangles.size(), 1u);
  EXPECT_EQ(out.vertices.size(), 3u);
}

TEST(Shells, OfTwoCubesAreTwoClosedOnes) {
  TriangleMesh mesh = unit_cube();
  append(mesh, unit_cube(), translation({3, 0, 0}));
  const auto found = shells(welded(mesh));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].closed && found[1].closed);
  EXPECT_EQ(found[0].triangles.front(), 0u);
  EXPECT_EQ(found[1].triangles.front(), 12u);
}

TEST(Shells, AreOpenWithAHoleOrATurnedTriangle) {
  TriangleMesh hole = unit_cube();
  hole.triangles.pop_back();
  EXPECT_FALSE(shells(hole).front().closed);
  TriangleMesh turned = unit_cube();
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_FALSE(shells(turned).front().closed);
  EXPECT_TRUE(shells(unit_cube()).front().closed);
}

TEST(Shells, ThatTouchInAPointStaySeparate) {
  TriangleMesh mesh = unit_cube();
  append(mesh, unit_cube(), translation({1, 1, 1}));
  EXPECT_EQ(shells(welded(mesh)).size(), 2u);
}

TEST(Mesh, VolumeOfATurnedAndShiftedBoxIsItsOwn) {
  Pose X = translation({100, -50, 3});
  X.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const TriangleMesh box = transformed(make_box({0, 0, 0}, {2, 3, 4}), X);
  EXPECT_NEAR(volume(box), 24, 1e-9);
  EXPECT_NEAR(radius_about(box, X.translation()), std::sqrt(4 + 9 + 16), 1e-9);
}

}  // namespace
}  // namespace aircut
