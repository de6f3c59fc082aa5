#include <gtest/gtest.h>

#include "logbook/logbook.h"

namespace aircut::logbook {
namespace {

Map small_map() {
  Map map;
  map.title = "Workspace of a test";
  map.kinds = {"reached", "with every tilt"};
  map.frame = "largest box";
  map.width = 500;
  MapPlane plane;
  plane.title = "Y = 0 mm";
  plane.x_name = "X, mm";
  plane.y_name = "Z, mm";
  plane.pitch = 10;
  plane.columns = 12;
  plane.rows = 8;
  for (int j = 0; j < plane.rows; ++j)
    for (int i = 0; i < plane.columns; ++i)
      plane.cells.push_back(static_cast<unsigned char>(i < 2 ? 0 : j < 3 ? 1 : 2));
  plane.frame = {20, 30, 100, 70};
  map.planes = {plane};
  return map;
}

// Width and height stand in the first chunk.
unsigned number_at(const std::string& png, std::size_t at) {
  unsigned n = 0;
  for (std::size_t i = 0; i < 4; ++i) n = n << 8 | static_cast<unsigned char>(png[at + i]);
  return n;
}

TEST(Map, IsAPictureOfTheWidthThatWasAskedFor) {
  const auto png = draw(small_map());
  ASSERT_TRUE(png);
  EXPECT_EQ(png->substr(1, 3), "PNG");
  EXPECT_EQ(number_at(*png, 16), 500u);
  EXPECT_GT(number_at(*png, 20), 200u);
  EXPECT_EQ(*png, *draw(small_map())) << "the same bytes each time";
}

TEST(Map, ShowsEveryCell) {
  Map other = small_map();
  other.planes[0].cells[5 * 12 + 6] = 0;
  EXPECT_NE(*draw(small_map()), *draw(other));
  other = small_map();
  other.planes[0].frame.reset();
  EXPECT_NE(*draw(small_map()), *draw(other));
}

TEST(Map, OfNothingIsAnError) { EXPECT_FALSE(draw(Map{})); }

}  // namespace
}  // namespace aircut::logbook
