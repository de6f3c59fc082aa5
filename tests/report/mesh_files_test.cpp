// Meshes that a run writes, read back by the importer, which shares no code with the writers.
#include <gtest/gtest.h>

#include <cstring>

#include "report/report.h"

namespace aircut::report {
namespace {

const TriangleMesh box = make_box(Vec3(-3, -4.25, 0), Vec3(5, 6, 7.125));

TEST(ThreeMf, IsReadBackInItsUnit) {
  const auto mesh = read_mesh_bytes(three_mf_bytes(box), "part.3mf", {.unit_mm = 25.4});
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 12u);
  EXPECT_NEAR(volume(*mesh), volume(box), 1e-3);
  EXPECT_EQ(bounds(*mesh).min(), bounds(box).min());
  EXPECT_EQ(bounds(*mesh).max(), bounds(box).max());
}

TEST(ThreeMf, GivesTheSameBytesTwiceAndPacksThem) {
  TriangleMesh many;
  for (int i = 0; i < 5000; ++i) append(many, make_box(Vec3(i, 0, 0), Vec3(i + 0.5, 0.25, 0.125)));
  const std::string bytes = three_mf_bytes(many);
  EXPECT_EQ(bytes, three_mf_bytes(many));
  EXPECT_LT(bytes.size(), stl_bytes(many).size());
  const auto mesh = read_mesh_bytes(bytes, "many.3mf");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), many.triangles.size());
  EXPECT_NEAR(volume(*mesh), volume(many), 1e-3);
}

TEST(Deviation, IsWrittenWithAValueAndAColourForEachVertex) {
  const std::vector<double> outside = {-1, -0.05, -0.03, -0.01, 0.01, 0.06, 0.15, 2};
  const DeviationScale scale({.tol_gouge = 0.02, .tol_excess = 0.05});
  const std::string bytes = ply_bytes(box, outside, scale.colors(outside));
  const auto mesh = read_mesh_bytes(bytes, "deviation.ply");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_NEAR(volume(*mesh), volume(box), 1e-3);
  // The second vertex: three coordinates, the value, the colour.
  const std::size_t row = bytes.find("end_header\n") + 11 + 19;
  float value = 0;
  std::memcpy(&value, bytes.data() + row + 12, 4);
  EXPECT_EQ(value, -0.05f);
  EXPECT_EQ(static_cast<std::uint8_t>(bytes[row + 16]), DeviationScale::color_of(2)[0]);
}

TEST(Deviation, IsGreenWithinTheTolerances) {
  const DeviationScale scale({.tol_gouge = 0.02, .tol_excess = 0.05, .allowance = 0.3});
  for (const double d : {-0.019, 0.0, 0.05, 0.34}) EXPECT_EQ(scale.step_of(d), 4) << d;
  for (const double d : {-0.021, -1.0}) EXPECT_LT(scale.step_of(d), 4) << d;
  for (const double d : {0.36, 9.0}) EXPECT_GT(scale.step_of(d), 4) << d;
}

}  // namespace
}  // namespace aircut::report
