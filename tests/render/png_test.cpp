#include <png.h>
#include <zlib.h>

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

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = at; i < at + 4; ++i) out = out << 8 | static_cast<unsigned char>(bytes[i]);
  return out;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  std::string out;
  for (const auto word : {static_cast<unsigned long>(data.size()), sum})
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(word >> shift & 0xff);
  return out.substr(0, 4) + body + out.substr(4);
}

// Takes the animation apart by the specification and puts each picture together as a plain PNG,
// which libpng then reads.
TEST(Png, AnimationHasItsPicturesInOrder) {
  auto draw = renderer(64, 40);
  std::vector<Image> images;
  std::vector<std::string> pngs;
  for (int i = 0; i < 3; ++i) {
    Scene scene = rich_scene();
    scene.caption.left = {std::to_string(i)};
    images.push_back(draw.draw(scene, rich_camera()));
    pngs.push_back(png_bytes(images.back()));
  }
  const std::string bytes = apng_bytes(pngs, 0.25);
  EXPECT_EQ(decoded(bytes).rgba, images[0].rgba);  // what an old viewer shows

  std::vector<std::string> data;
  std::uint32_t sequence = 0;
  std::string types;
  for (std::size_t at = 8; at < bytes.size(); at += 12 + number_at(bytes, at)) {
    const std::size_t size = number_at(bytes, at);
    const std::string type = bytes.substr(at + 4, 4);
    types += type + " ";
    EXPECT_EQ(number_at(bytes, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + at + 4,
                    static_cast<uInt>(size + 4)))
        << type;
    if (type == "acTL") {
      EXPECT_EQ(number_at(bytes, at + 8), 3u);
    } else if (type == "fcTL") {
      EXPECT_EQ(number_at(bytes, at + 8), sequence++);
      EXPECT_EQ(number_at(bytes, at + 12), 64u);
      EXPECT_EQ(number_at(bytes, at + 16), 40u);
      EXPECT_EQ(number_at(bytes, at + 28), 250u << 16 | 1000u);
      data.emplace_back();
    } else if (type == "IDAT") {
      data.back() += bytes.substr(at + 8, size);
    } else if (type == "fdAT") {
      EXPECT_EQ(number_at(bytes, at + 8), sequence++);
      data.back() += bytes.substr(at + 12, size - 4);
    }
  }
  EXPECT_LT(types.find("acTL"), types.find("IDAT"));
  EXPECT_TRUE(types.ends_with("IEND "));
  ASSERT_EQ(data.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string head = pngs[i].substr(0, 8 + 12 + 13),
                      end = pngs[i].substr(pngs[i].size() - 12);
    EXPECT_EQ(decoded(head + chunk("IDAT", data[i]) + end).rgba, images[i].rgba) << i;
  }
  EXPECT_EQ(apng_bytes({}, 1), "");
  const std::vector<std::string> mixed = {pngs[0],
                                          png_bytes(renderer(32, 32).draw({}, rich_camera()))};
  EXPECT_EQ(apng_bytes(mixed, 1), "");
}

TEST(Png, OfAPictureWithoutSizeIsEmpty) {
  EXPECT_EQ(png_bytes({}), "");
  EXPECT_EQ(png_bytes({10, 10, {}}), "");  // fewer bytes than pixels
}

}  // namespace
}  // namespace aircut::render
