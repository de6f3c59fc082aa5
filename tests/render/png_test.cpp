#include <png.h>

#include <cstring>

#include "render/scenes.h"

namespace aircut::render {
namespace {

Image decoded(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image out;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return out;
  png.format = PNG_FORMAT_RGBA;
  out.width = static_cast<int>(png.width);
  out.height = static_cast<int>(png.height);
  out.rgba.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, out.rgba.data(), 0, nullptr) == 0) out.rgba.clear();
  return out;
}

TEST(Png, ReadsBackToTheSamePixels) {
  const Image image = renderer(200, 120).draw(rich_scene(), rich_camera());
  const Image again = decoded(png_bytes(image));
  EXPECT_EQ(again.width, 200);
  EXPECT_EQ(again.height, 120);
  EXPECT_EQ(again.rgba, image.rgba);
}

TEST(Png, OfAPictureWithoutSizeIsEmpty) {
  EXPECT_EQ(png_bytes({}), "");
  EXPECT_EQ(png_bytes({10, 10, {}}), "");  // fewer bytes than pixels
}

}  // namespace
}  // namespace aircut::render
