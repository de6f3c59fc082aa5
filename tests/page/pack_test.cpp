// Packed numbers are read back by an own little reader here and by page.js in the browser test.
#include "page/pack.h"

#include <gtest/gtest.h>

#include <random>

namespace aircut::page {
namespace {

std::vector<std::int64_t> read_back(const std::string& bytes, const Row& row) {
  std::vector<std::int64_t> out;
  std::size_t at = row.at;
  std::int64_t value = 0;
  for (std::size_t i = 0; i < row.count; ++i) {
    std::uint64_t zigzag = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes[at++]);
      zigzag |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) break;
    }
    value += zigzag % 2 ? -static_cast<std::int64_t>(zigzag / 2) - 1
                        : static_cast<std::int64_t>(zigzag / 2);
    out.push_back(value);
  }
  return out;
}

TEST(Pack, IntegersComeBackAsTheyWere) {
  std::mt19937_64 random(7);
  Blob blob;
  std::vector<std::vector<std::int64_t>> rows = {{}, {0}, {-1}, {127, 128, -64, -65, 1LL << 40}};
  for (int i = 0; i < 50; ++i) {
    rows.emplace_back();
    for (int k = 0; k < 200; ++k)
      rows.back().push_back(static_cast<std::int64_t>(random()) >> (14 + random() % 50));
  }
  std::vector<Row> where;
  for (const auto& row : rows) where.push_back(blob.add(row));
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(read_back(blob.bytes(), where[i]), rows[i]);
}

// A box whose faces are n x n squares.
TriangleMesh gridded_box(double size, int n) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, size}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = size * i / n;
          p[(axis + 2) % 3] = size * k / n;
          mesh.vertices.push_back(p);
        }
      const auto at = [&](int i, int k) {
        return first + static_cast<std::uint32_t>(i * (n + 1) + k);
      };
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
          std::array<std::uint32_t, 3> a = {at(i, k), at(i + 1, k), at(i + 1, k + 1)};
          std::array<std::uint32_t, 3> b = {at(i, k), at(i + 1, k + 1), at(i, k + 1)};
          if (side == 0) std::swap(a[1], a[2]), std::swap(b[1], b[2]);
          mesh.triangles.push_back(a);
          mesh.triangles.push_back(b);
        }
    }
  return welded(mesh);
}

TEST(Pack, AClusteredBoxStaysABox) {
  const TriangleMesh fine = gridded_box(100, 100);
  const TriangleMesh coarse = at_most(fine, 3000);
  EXPECT_LE(coarse.triangles.size(), 3000u);
  EXPECT_GT(coarse.triangles.size(), 500u);
  EXPECT_NEAR(volume(coarse), 1e6, 5e3);
  for (const Vec3& v : coarse.vertices) {
    double off = 1e9;  // from the nearest of the six planes
    for (int axis = 0; axis < 3; ++axis)
      off = std::min({off, std::abs(v[axis]), std::abs(v[axis] - 100)});
    EXPECT_LT(off, 0.1);
  }
  // Its corners are where they were.
  for (const double x : {0.0, 100.0})
    for (const double y : {0.0, 100.0})
      for (const double z : {0.0, 100.0}) {
        double nearest = 1e9;
        for (const Vec3& v : coarse.vertices)
          nearest = std::min(nearest, (v - Vec3(x, y, z)).norm());
        EXPECT_LT(nearest, 0.5);
      }
}

TEST(Pack, ASmallMeshIsLeftAsItIs) {
  const TriangleMesh box = gridded_box(10, 2);
  EXPECT_EQ(at_most(box, 1000).vertices.size(), box.vertices.size());
}

}  // namespace
}  // namespace aircut::page
