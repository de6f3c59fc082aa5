#include "render/canvas.h"
#include "render/scenes.h"

namespace aircut::render {
namespace {

TEST(Sheet, LaysItsCellsOutInAGrid) {
  std::vector<SheetCell> cells;
  for (const Ink ink : {Ink{200, 0, 0}, Ink{0, 200, 0}, Ink{0, 0, 200}})
    cells.push_back({make_image(640, 400, ink), "cell"});
  const Image sheet = contact_sheet(cells, 2, 320, "Part 7, 3 pictures");
  ASSERT_GT(sheet.width, 640);
  ASSERT_GT(sheet.height, 400);
  // Where the pure colours are: red left of green, blue below red.
  Vec2 centre[3] = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
  int count[3] = {0, 0, 0};
  for (int y = 0; y < sheet.height; ++y)
    for (int x = 0; x < sheet.width; ++x) {
      const auto c = pixel(sheet, x, y);
      for (std::size_t k = 0; k < 3; ++k)
        if (c[k] > 190 && c[(k + 1) % 3] < 10 && c[(k + 2) % 3] < 10) {
          centre[k] += Vec2(x, y);
          ++count[k];
        }
    }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(count[k], 320 * 200, 10);
    centre[k] /= count[k];
  }
  EXPECT_LT(centre[0].x() + 300, centre[1].x());
  EXPECT_NEAR(centre[0].y(), centre[1].y(), 1);
  EXPECT_NEAR(centre[0].x(), centre[2].x(), 1);
  EXPECT_LT(centre[0].y() + 200, centre[2].y());
}

TEST(Sheet, TakesOddRequests) {
  EXPECT_GT(contact_sheet({}, 0, 0, "").width, 0);
  EXPECT_GT(contact_sheet({{Image{}, std::string(1000, 'x')}}, -3, 5, std::string(1000, 't')).width,
            0);
}

TEST(Resampling, KeepsAnEvenColourAndTheMeanLight) {
  const Image even = resampled(make_image(301, 77, {90, 140, 200}), 100, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 100; ++x) EXPECT_EQ(pixel(even, x, y), (std::array<int, 3>{90, 140, 200}));
  // A fine chequer of black and white carries half the light: 188 in sRGB, not 128.
  Image chequer = make_image(256, 256, {});
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      if ((x + y) % 2 == 0) blend(chequer, x, y, {255, 255, 255}, 1);
  const Image grey = resampled(chequer, 32, 32);
  EXPECT_NEAR(pixel(grey, 16, 16)[0], 188, 2);
}

TEST(Canvas, CoversTheAreaOfItsShapes) {
  const auto ink_sum = [](const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += 1 - image.rgba[i] / 255.0;
    return sum;
  };
  const Ink white{255, 255, 255}, black{0, 0, 0};
  Image disc = make_image(100, 100, white);
  fill_disc(disc, Vec2(50.3, 49.8), 30, black);
  EXPECT_NEAR(ink_sum(disc), std::numbers::pi * 900, 15);
  Image line = make_image(100, 100, white);
  draw_line(line, Vec2(20, 20), Vec2(80, 60), 4, black);
  EXPECT_NEAR(ink_sum(line), 4 * Vec2(60, 40).norm() + std::numbers::pi * 4, 6);
  Image triangle = make_image(100, 100, white);
  fill_triangle(triangle, Vec2(10, 10), Vec2(90, 20), Vec2(30, 80), black);
  EXPECT_NEAR(ink_sum(triangle), 2700, 15);
  Image outside = make_image(20, 20, white);
  fill_disc(outside, Vec2(-500, 1e7), 30, black);
  EXPECT_EQ(ink_sum(outside), 0);
}

}  // namespace
}  // namespace aircut::render
