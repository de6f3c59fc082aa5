#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "base/base.h"

namespace aircut {
namespace {

/// MiB of mapped files that are in this process' memory.
double mapped_mib() {
  std::ifstream statm("/proc/self/statm");
  long size = 0, resident = 0, shared = 0;
  statm >> size >> resident >> shared;
  return static_cast<double>(shared) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::string numbered_lines(std::size_t bytes) {
  std::string text;
  for (int i = 0; text.size() < bytes; ++i) text += "G1 X" + std::to_string(i) + "\n";
  return text;
}

class TemporaryFile : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() / "aircut-source-XXXXXX").string();
    const int fd = ::mkstemp(path_.data());
    ASSERT_GE(fd, 0);
    ::close(fd);
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_;
};

using Texts = TemporaryFile;

TEST_F(Texts, AreReadWithoutFillingTheMemory) {
  const std::string written = numbered_lines(64 << 20);
  std::ofstream(path_, std::ios::binary) << written;
  SourceMap sources;
  const auto text = sources.open(path_);
  ASSERT_TRUE(text);
  const std::string_view content = (*text)->content();
  const double before = mapped_mib();
  double most = 0;
  Reading reading(**text);
  constexpr std::size_t part = 1 << 20;
  for (std::size_t at = 0; at < content.size(); at += part) {
    ASSERT_EQ(content.substr(at, part), std::string_view(written).substr(at, part));
    reading.at(at, at + part);
    most = std::max(most, mapped_mib() - before);
  }
  EXPECT_GT(most, 1);   // the measure sees what is read
  EXPECT_LT(most, 30);  // and most of it is let go of
  EXPECT_TRUE(content == written);
}

TEST_F(Texts, CountJumpsAsWhatTheyBringIn) {
  std::ofstream(path_, std::ios::binary) << numbered_lines(64 << 20);
  SourceMap sources;
  const auto text = sources.open(path_);
  ASSERT_TRUE(text);
  const std::string_view content = (*text)->content();
  const double before = mapped_mib();
  double most = 0;
  std::size_t sum = 0;
  Reading reading(**text);
  for (std::size_t i = 0, at = 0; i < 5000; ++i, at = (at + 7'654'321) % content.size()) {
    sum += static_cast<unsigned char>(content[at]);
    reading.at(at, at + 1);
    if (i % 7 == 0) most = std::max(most, mapped_mib() - before);
  }
  EXPECT_GT(sum, 0u);
  EXPECT_LT(most, 30);
}

TEST(Streams, GiveTheSameTextWhateverTheirLength) {
  for (const std::size_t bytes : {0, 100, 7 << 20, 20 << 20}) {
    const std::string written = bytes == 0 ? "" : numbered_lines(bytes);
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    std::thread writer([&] {
      std::size_t at = 0;
      while (at < written.size()) {
        const ssize_t n = ::write(ends[1], written.data() + at, written.size() - at);
        if (n <= 0) break;
        at += static_cast<std::size_t>(n);
      }
      ::close(ends[1]);
    });
    std::FILE* in = ::fdopen(ends[0], "rb");
    SourceMap sources;
    const auto text = sources.read(in, "-");
    writer.join();
    std::fclose(in);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ((*text)->name(), "-");
    EXPECT_TRUE((*text)->content() == written) << bytes;
  }
}

TEST_F(Texts, ComeFromRedirectedFilesAndTheirHashesAreThoseOfTheBytes) {
  const std::string written = numbered_lines(10 << 20);
  std::ofstream(path_, std::ios::binary) << written;
  std::FILE* in = std::fopen(path_.c_str(), "rb");
  SourceMap sources;
  const auto text = sources.read(in, "-");
  std::fclose(in);
  ASSERT_TRUE(text);
  EXPECT_TRUE((*text)->content() == written);
  EXPECT_EQ(sha256(**text), sha256(written));
}

}  // namespace
}  // namespace aircut
