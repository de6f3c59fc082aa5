#include "render/draw_mesh.h"

#include <algorithm>
#include <limits>

#include "render/scenes.h"

namespace aircut::render {
namespace {

std::size_t creases(const DrawMesh& mesh) {
  return static_cast<std::size_t>(std::count_if(mesh.edges.begin(), mesh.edges.end(),
                                                [](const DrawEdge& e) { return e.crease; }));
}

TEST(DrawMesh, GivesABoxThreeNormalsPerCornerAndItsTwelveEdges) {
  const DrawMesh mesh = make_draw_mesh(block(10, 20, 30));
  EXPECT_EQ(mesh.vertices.size(), 24u);
  EXPECT_EQ(mesh.indices.size(), 36u);
  EXPECT_EQ(mesh.edges.size(), 12u);  // the diagonals lie in a plane
  EXPECT_EQ(creases(mesh), 12u);
  EXPECT_TRUE(mesh.closed);
  for (const DrawVertex& v : mesh.vertices) {
    const Vec3 n(v.normal[0], v.normal[1], v.normal[2]);
    EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1, 1e-6);
  }
}

TEST(DrawMesh, RoundsACylinderButKeepsItsRimsSharp) {
  constexpr unsigned facets = 24;
  const DrawMesh mesh = make_draw_mesh(cylinder(10, 40, facets));
  EXPECT_TRUE(mesh.closed);
  EXPECT_EQ(creases(mesh), 2 * facets);
  for (const DrawVertex& v : mesh.vertices) {
    const Vec3 n(v.normal[0], v.normal[1], v.normal[2]);
    if (std::abs(n.z()) > 0.5) continue;  // an end
    const Vec3 radial = Vec3(v.position[0], v.position[1], 0).normalized();
    EXPECT_GT(n.dot(radial), 0.999);
  }
}

TEST(DrawMesh, WeldsTrianglesThatShareOnlyPlaces) {
  const TriangleMesh box = block(10, 20, 30);
  TriangleMesh soup;
  for (const auto& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const auto i : t) soup.vertices.push_back(box.vertices[i]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const DrawMesh mesh = make_draw_mesh(soup);
  EXPECT_EQ(mesh.vertices.size(), 24u);
  EXPECT_TRUE(mesh.closed);
}

TEST(DrawMesh, DrawsTheRimOfAnOpenMeshAndShowsItsBack) {
  TriangleMesh open = block(10, 10, 10);
  open.triangles.resize(10);  // one side is missing
  const DrawMesh mesh = make_draw_mesh(open);
  EXPECT_FALSE(mesh.closed);
  EXPECT_EQ(creases(mesh), 12u);
}

TEST(DrawMesh, DoesNotCullAMeshThatIsInsideOut) {
  TriangleMesh turned = block(10, 10, 10);
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(make_draw_mesh(turned).closed);
}

TEST(DrawMesh, LeavesOutTrianglesWithoutAreaAndBrokenNumbers) {
  TriangleMesh mesh = block(10, 10, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mesh.vertices.emplace_back(nan, 0, 0);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 1, 8});
  mesh.triangles.push_back({0, 1, 77});  // no such vertex
  const DrawMesh drawn = make_draw_mesh(mesh);
  EXPECT_EQ(drawn.indices.size(), 36u);
  EXPECT_TRUE(drawn.box.min().allFinite());
  EXPECT_TRUE(make_draw_mesh({}).indices.empty());
}

}  // namespace
}  // namespace aircut::render
