#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/geometry.h"

namespace aircut {
namespace {

constexpr double pi = std::numbers::pi;

void expect_one_closed_shell(const TriangleMesh& mesh) {
  const auto found = shells(welded(mesh));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().closed);
}

TEST(Revolve, MakesACylinderThatContainsTheTrueOne) {
  const double tolerance = 0.01;
  const TriangleMesh mesh = revolve({{5, 0}, {5, 20}}, tolerance);
  expect_one_closed_shell(mesh);
  const double true_volume = pi * 25 * 20;
  EXPECT_GE(volume(mesh), true_volume);
  EXPECT_LE(volume(mesh), pi * (5 + tolerance) * (5 + tolerance) * 20);
  for (const auto& t : mesh.triangles) {
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                       .normalized();
    if (std::abs(n.z()) > 0.5) continue;
    // The side's plane must not cut into the cylinder.
    EXPECT_GE(n.dot(mesh.vertices[t[0]]), 5 - 1e-12);
    EXPECT_LE(std::hypot(mesh.vertices[t[0]].x(), mesh.vertices[t[0]].y()), 5 + tolerance + 1e-12);
  }
}

TEST(Revolve, ClosesATaperedToolWithAPointAndLevelSteps) {
  const Profile drill = {{0, 0}, {3, 1.8}, {3, 30}, {10, 30}, {10, 60}, {25, 60}, {25, 80}};
  const TriangleMesh mesh = revolve(drill, 0.02);
  expect_one_closed_shell(mesh);
  const double exact = pi * (9 * 1.8 / 3 + 9 * 28.2 + 100 * 30 + 625 * 20);
  EXPECT_GT(volume(mesh), exact);
  EXPECT_LT(volume(mesh), exact * 1.01);
}

TEST(Revolve, TakesEnoughFacetsForTheLargestRadius) {
  for (const double tolerance : {1.0, 0.1, 0.01, 0.001}) {
    const TriangleMesh mesh = revolve({{50, 0}, {50, 1}}, tolerance);
    double worst = 0;
    for (const Vec3& v : mesh.vertices) worst = std::max(worst, std::hypot(v.x(), v.y()));
    EXPECT_LE(worst, 50 + tolerance + 1e-12);
    const std::size_t facets = (mesh.vertices.size() - 2) / 2;
    EXPECT_EQ(facets % 4, 0u);
    EXPECT_GE(facets, 12u);
  }
}

TEST(Revolve, OfARingWithAGrooveStaysClosed) {
  expect_one_closed_shell(revolve({{4, 0}, {8, 0}, {8, 2}, {5, 2}, {5, 4}, {8, 4}, {8, 6}}, 0.05));
}

TEST(Revolve, OfNothingIsEmpty) {
  EXPECT_TRUE(revolve({}, 0.01).empty());
  EXPECT_TRUE(revolve({{0, 0}, {0, 5}}, 0.01).empty());
}

TEST(Revolve, WithAToleranceOfZeroStillEnds) {
  const TriangleMesh mesh = revolve({{1, 0}, {1, 1}}, 0.0);
  expect_one_closed_shell(mesh);
  EXPECT_LT(mesh.triangles.size(), 20000u);
}

}  // namespace
}  // namespace aircut
