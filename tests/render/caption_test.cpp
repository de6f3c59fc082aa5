#include "render/scenes.h"
#include "render/text.h"

namespace aircut::render {
namespace {

// The smallest rectangle that holds all pixels in which two pictures differ.
struct Changed {
  int x0 = 1 << 20, y0 = 1 << 20, x1 = -1, y1 = -1;
  int count = 0;
};

Changed changed(const Image& a, const Image& b) {
  Changed out;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      if (pixel(a, x, y) != pixel(b, x, y)) {
        out.x0 = std::min(out.x0, x), out.x1 = std::max(out.x1, x);
        out.y0 = std::min(out.y0, y), out.y1 = std::max(out.y1, y);
        ++out.count;
      }
  return out;
}

Fonts fonts() {
  auto made = Fonts::load(font_folders());
  if (!made) {
    ADD_FAILURE() << made.error().message;
    std::abort();
  }
  return std::move(*made);
}

constexpr int width = 640, height = 400;

TEST(Caption, StandsInsideThePicture) {
  Renderer r = renderer(width, height);
  Scene scene = bare_scene({});
  const Image plain = r.draw(scene, front_camera(200));
  scene.caption.left = {"part.ngc", "N128 G1 X40 F600"};
  const Changed left = changed(plain, r.draw(scene, front_camera(200)));
  EXPECT_GT(left.count, 500);
  EXPECT_GT(left.x0, 0);
  EXPECT_LT(left.x1, width / 2);
  EXPECT_LT(left.y1, height / 3);
  scene.caption = {};
  scene.caption.right = {"t = 1 s", "X 1.000"};
  const Changed right = changed(plain, r.draw(scene, front_camera(200)));
  EXPECT_GT(right.x0, width / 2);
  EXPECT_LT(right.x1, width - 1);
}

TEST(Caption, CutsLongLinesAndKeepsTheTwoSidesApart) {
  Renderer r = renderer(width, height);
  Scene scene = bare_scene({});
  const Image plain = r.draw(scene, front_camera(200));
  scene.caption.left = {std::string(500, 'W')};
  scene.caption.right = {std::string(500, 'M')};
  const Image image = r.draw(scene, front_camera(200));
  const Changed all = changed(plain, image);
  EXPECT_GT(all.x0, 0);
  EXPECT_LT(all.x1, width - 1);
  scene.caption.right.clear();
  EXPECT_LT(changed(plain, r.draw(scene, front_camera(200))).x1, width - 1);
}

TEST(Caption, WritesTheAlarmInRed) {
  Renderer r = renderer(width, height);
  Scene scene = bare_scene({});
  scene.caption.left = {"part.ngc"};
  scene.caption.alarm = "collision: holder hits vise";
  const Image image = r.draw(scene, front_camera(200));
  int red = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) red += is_red(pixel(image, x, y)) ? 1 : 0;
  EXPECT_GT(red, 1000);
}

TEST(Text, IsNoWiderThanItsRoom) {
  const Fonts f = fonts();
  const std::string text = "G1 X40.0 Y12.5 ; größe – ½ µm";
  EXPECT_EQ(f.fitted(text, Face::mono, 14, 10000), text);
  for (const double room : {0.0, 5.0, 20.0, 77.0, 150.0}) {
    const std::string cut = f.fitted(text, Face::mono, 14, room);
    EXPECT_LE(f.width(cut, Face::mono, 14), room);
    if (room > 20) {
      EXPECT_EQ(cut.substr(cut.size() - 3), "…");
    }
  }
}

TEST(Text, SpellsOutWhatTheFontLacks) {
  const Fonts f = fonts();
  // A character of no DejaVu font, a control character, a broken byte.
  EXPECT_DOUBLE_EQ(f.width("\xF0\x9F\xA6\xBA", Face::sans, 14),
                   f.width("‹U+1F9BA›", Face::sans, 14));
  EXPECT_DOUBLE_EQ(f.width("\x1B", Face::mono, 14), f.width("^[", Face::mono, 14));
  EXPECT_DOUBLE_EQ(f.width("\xFF", Face::sans, 14), f.width("\xEF\xBF\xBD", Face::sans, 14));
  EXPECT_DOUBLE_EQ(f.width("\xC3", Face::sans, 14), f.width("\xEF\xBF\xBD", Face::sans, 14));
  EXPECT_DOUBLE_EQ(f.width("\xC2\x9B", Face::mono, 14), f.width("‹U+009B›", Face::mono, 14));
}

TEST(Text, NeedsItsFonts) {
  const std::vector<std::string> nowhere = {"/nonexistent/fonts"};
  const auto missing = Fonts::load(nowhere);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, "output_failed");
  EXPECT_NE(missing.error().message.find("/nonexistent/fonts"), std::string::npos);
}

}  // namespace
}  // namespace aircut::render
