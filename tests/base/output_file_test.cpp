#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "base/base.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "aircut-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

TEST_F(OutputFileTest, AppearsWholeOnCommit) {
  auto file = OutputFile::create((folder_ / "a.txt").string());
  ASSERT_TRUE(file);
  file->write("hello");
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
  ASSERT_TRUE(file->commit());
  std::ifstream in(folder_ / "a.txt");
  std::string text;
  in >> text;
  EXPECT_EQ(text, "hello");
  EXPECT_EQ(files(), 1u);
}

TEST_F(OutputFileTest, LeavesNothingWithoutCommit) {
  {
    auto file = OutputFile::create((folder_ / "a.txt").string());
    ASSERT_TRUE(file);
    file->write("half");
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(OutputFileTest, SaysWhyAFolderCantBeWritten) {
  const auto file = OutputFile::create((folder_ / "none/a.txt").string());
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, "output_failed");
  EXPECT_NE(file.error().message.find("No such file"), std::string::npos);
}

TEST_F(OutputFileTest, NeverReplacesWhatIsNoRegularFile) {
  fs::create_symlink("elsewhere", folder_ / "link");
  for (const std::string& path : {std::string("/dev/null"), (folder_ / "link").string()}) {
    const auto file = OutputFile::create(path);
    ASSERT_FALSE(file) << path;
    EXPECT_NE(file.error().message.find("not a regular file"), std::string::npos);
  }
}

TEST_F(OutputFileTest, ReportsAFolderThatVanished) {
  auto file = OutputFile::create((folder_ / "a.txt").string());
  ASSERT_TRUE(file);
  file->write("x");
  fs::remove_all(folder_);
  const auto done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, "output_failed");
}

TEST(SourceMapTest, SaysWhyAFileCantBeRead) {
  SourceMap sources;
  const auto missing = sources.open("/nonexistent/p.ngc");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
  const auto folder = sources.open("/tmp");
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("it is a folder"), std::string::npos);
  EXPECT_FALSE(sources.open("/dev/zero"));
}

}  // namespace
}  // namespace aircut
