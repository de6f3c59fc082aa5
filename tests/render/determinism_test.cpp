#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

#include "render/scenes.h"

namespace aircut::render {
namespace {

// FNV-1a of the PNG.
std::string digest() {
  const std::string bytes = png_bytes(renderer(320, 200).draw(rich_scene(), rich_camera()));
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

TEST(Backends, DrawTheSamePicture) {
  auto egl = Renderer::create({320, 200, Supersample::once, Backend::egl});
  if (!egl) GTEST_SKIP() << egl.error().message;
  auto osmesa = Renderer::create({320, 200, Supersample::once, Backend::osmesa});
  ASSERT_TRUE(osmesa) << osmesa.error().message;
  // Turn by turn, so that each has to bind its own context.
  for (int i = 0; i < 2; ++i) {
    const Image a = egl->draw(rich_scene(), rich_camera());
    const Image b = osmesa->draw(rich_scene(), rich_camera());
    EXPECT_LT(mean_difference(a, b), 0.5);
    EXPECT_EQ(egl->visible_pixels(rich_scene(), rich_camera()),
              osmesa->visible_pixels(rich_scene(), rich_camera()));
  }
}

// Run in a process of its own by the test below.
TEST(Determinism, SaysADigest) {
  std::printf("digest=%s\n", digest().c_str());
  EXPECT_EQ(digest().size(), 16u);
}

TEST(Determinism, GivesTheSameBytesTwiceInOneProcess) {
  Renderer r = renderer(320, 200);
  const std::string first = png_bytes(r.draw(rich_scene(), rich_camera()));
  r.visible_pixels(rich_scene(), rich_camera());
  EXPECT_EQ(png_bytes(r.draw(rich_scene(), rich_camera())), first);
  EXPECT_EQ(png_bytes(renderer(320, 200).draw(rich_scene(), rich_camera())), first);
}

TEST(Determinism, GivesTheSameBytesInAnotherProcessWithAnotherNumberOfThreads) {
  std::array<char, 4096> path{};
  ASSERT_GT(readlink("/proc/self/exe", path.data(), path.size() - 1), 0);
  for (const char* threads : {"0", "1", "2"}) {
    const std::string command = std::string("LP_NUM_THREADS=") + threads + " '" + path.data() +
                                "' --gtest_filter=Determinism.SaysADigest";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string out;
    std::array<char, 512> part{};
    while (fgets(part.data(), part.size(), pipe) != nullptr) out += part.data();
    EXPECT_EQ(pclose(pipe), 0);
    EXPECT_NE(out.find("digest=" + digest()), std::string::npos) << out;
  }
}

}  // namespace
}  // namespace aircut::render
