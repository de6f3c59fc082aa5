// Logs as HDF5: the same numbers back, and a message for every damaged file.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "logbook/logbook.h"

namespace aircut::logbook {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

// A log of `rows` rows with numbers that have all their digits.
std::string text_of_log(int rows) {
  std::string out =
      "# format=aircut-joints-1\n# program=a b.ngc\n# machine=\n# servo_period_s=0.001\n"
      "# every=1\n# joints=X:mm,C:deg\n# limits_v=100,100\n# limits_a=1000,1000\n"
      "# limits_j=20000,inf\n# end_time_s=0.5\n# samples=" +
      std::to_string(rows) +
      "\nt,line,block,motion,feed_cmd,feed_act,s,q0,q1,v0,v1,a0,a1,x,y,z,a,b,c,u,v,w,tool,"
      "spindle_rpm,spindle_rev,sync_error,flags\n";
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1e3, 1e3);
  for (int k = 0; k < rows; ++k) {
    out += shortest(k * 0.001) + ",100000," + std::to_string(k) + ",2";
    for (int i = 0; i < 18; ++i) out += "," + shortest(uniform(random));
    out += ",7,1e-300,0.5,0,132\n";
  }
  return out;
}

struct Hdf5 : ::testing::Test {
  void SetUp() override {
    const auto ready = hdf5_ready();
    ASSERT_TRUE(ready) << ready.error().message;
    std::string name = (fs::temp_directory_path() / "aircut-hdf5-XXXXXX").string();
    folder = ::mkdtemp(name.data());
  }
  void TearDown() override {
    if (!folder.empty()) fs::remove_all(folder);
  }
  std::string path(const std::string& name) const { return folder + "/" + name; }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }
  std::string folder;
};

TEST_F(Hdf5, GivesTheTextBackByteByByte) {
  for (const int rows : {0, 1, 65536, 65537}) {
    const SourceText log("log.csv", text_of_log(rows));
    const auto done = write_hdf5(log, path("log.h5"));
    ASSERT_TRUE(done) << done.error().message;
    SourceMap sources;
    const auto back = open_log(sources, path("log.h5"));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE((*back)->content() == log.content()) << rows << " rows";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary file is left";
  }
}

TEST_F(Hdf5, IsTheSameBytesEachTime) {
  const SourceText log("log.csv", text_of_log(1000));
  ASSERT_TRUE(write_hdf5(log, path("a.h5")));
  ASSERT_TRUE(write_hdf5(log, path("b.h5")));
  EXPECT_EQ(bytes_of(path("a.h5")), bytes_of(path("b.h5")));
}

TEST_F(Hdf5, ATextThatIsNoLogLeavesNoFile) {
  const SourceText bad("log.csv", text_of_log(5) + "0.1,nothing\n");
  EXPECT_FALSE(write_hdf5(bad, path("log.h5")));
  EXPECT_TRUE(fs::is_empty(folder));
}

// Cut off anywhere, or with bytes changed anywhere: read, or refused with a message; never a crash.
TEST_F(Hdf5, ADamagedFileIsRefusedOrRead) {
  ASSERT_TRUE(write_hdf5(SourceText("log.csv", text_of_log(40)), path("good.h5")));
  const std::string good = bytes_of(path("good.h5"));
  std::mt19937 random(8);
  int refused = 0;
  for (int i = 0; i < 75; ++i) {
    std::string bad = good;
    if (i % 3 == 0)
      bad.resize(random() % good.size());
    else
      for (int n = i % 3 == 1 ? 1 : 40; n > 0; --n)
        bad[random() % (i % 2 ? bad.size() : 2048)] = static_cast<char>(random());
    write("bad.h5", bad);
    SourceMap sources;
    const auto text = open_log(sources, path("bad.h5"));
    const auto log = text ? check(**text, {}) : tl::unexpected(text.error());
    if (log) continue;
    ++refused;
    EXPECT_EQ(log.error().kind, "input");
    EXPECT_FALSE(log.error().message.empty());
  }
  EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace aircut::logbook
